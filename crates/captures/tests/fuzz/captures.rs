//! Fuzz tests of logic analysers' captures.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::TestCaseError;

use tofsim_captures::ila::read::{Column, WIDEST_SAMPLE};

use crate::ila;
use crate::ila::fixtures;

use super::edit::{edited, edits};
use super::fuzz;

/// Texts with a meaning in one of the formats.
const PIECES: [&str; 38] = [
    ",",
    "\n",
    "\r\n",
    "\r",
    "\"",
    "\"\"",
    "0",
    "1",
    "-1",
    "X",
    "f",
    "18446744073709551615",
    "[",
    "]",
    ":",
    "[4095:0]",
    "[0:15]",
    "[4294967295:4294967290]",
    "Radix - UNSIGNED",
    "SIGNED",
    "BINARY",
    "HEX",
    "GAP",
    "ch[0]: ",
    "data_width:",
    "sample_count:1048576\n",
    "window_marks:0 1\n",
    "gaps:2\n",
    "trigger_marks:1 2\n",
    "<net name=\"a[1]\"/>",
    "<probe type=\"ila\">",
    "&lt;",
    "</nets>",
    "\u{feff}",
    "=====\n",
    ";",
    "#7\n",
    "-1\"",
];

/// Reads a file to its end or its first error; `size` is its uncompressed size [bytes].
fn drive(bytes: &[u8], size: usize) -> Result<(), TestCaseError> {
    match ila::read_bytes(bytes, None) {
        Ok((opened, rows)) => {
            let words: usize = opened.columns.iter().map(Column::words).sum();
            // The shortest head of a probe of 64 words is `a[4095:0],`.
            prop_assert!(words <= WIDEST_SAMPLE as usize && words <= 8 * size);
            // A VCD alone may say with one number how many samples there are.
            prop_assert!(opened.columns.len() <= size && rows.len() <= size.max(1 << 20));
            prop_assert!(rows.iter().all(|row| row.value.len() == words));
        }
        Err(error) => prop_assert!(error.starts_with("capture"), "{}", error),
    }
    Ok(())
}

const TABLES: [&str; 7] = [
    "radices.csv",
    "legacy.csv",
    "system_ila.csv",
    "chipscopy_gap.csv",
    "windows.csv",
    "wide.csv",
    "empty.csv",
];

#[test]
fn bytes_that_mean_nothing() {
    let head = select(vec!["", "PK", "PK\u{3}\u{4}", "Sample in Buffer,Sample in Window,TRIGGER,"]);
    fuzz((head, vec(any::<u8>(), 0..300)), |(head, rest)| {
        let bytes = [head.as_bytes(), &rest].concat();
        drive(&bytes, bytes.len())
    });
}

#[test]
fn tables_that_are_nearly_right() {
    fuzz((select(&TABLES[..]), edits(&PIECES)), |(name, edits)| {
        let bytes = edited(fixtures::bytes(name), &edits);
        drive(&bytes, bytes.len())
    });
}

#[test]
fn archives_of_entries_that_are_nearly_right() {
    let entries = fixtures::PARTS;
    let present = vec(prop::bool::weighted(0.7), entries.len());
    fuzz((present, select(entries.to_vec()), edits(&PIECES)), |(present, target, edits)| {
        let content = |name: &str| {
            let bytes = fixtures::bytes(&format!("views/{name}"));
            if name == target { edited(bytes, &edits) } else { bytes }
        };
        let chosen = entries.iter().zip(&present).filter(|(_, present)| **present);
        let chosen: Vec<_> = chosen.map(|(&name, _)| (name, content(name))).collect();
        let size = chosen.iter().map(|(_, content)| content.len()).sum();
        let borrowed: Vec<_> = chosen.iter().map(|(name, bytes)| (*name, &bytes[..])).collect();
        drive(&ila::archive(&borrowed), size)
    });
}

#[test]
fn archives_that_are_nearly_right() {
    let size = 8 * fixtures::archive_but(&[]).len();
    fuzz(edits(&PIECES), |edits| drive(&edited(fixtures::archive_but(&[]), &edits), size));
}
