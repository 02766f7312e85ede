//! Tests of captures that were saved by a spreadsheet or edited by hand.

use tofsim_captures::source::{Source, SourceFormat};

use crate::ila::fixtures::bytes;
use crate::ila::read_bytes;

fn text(name: &str) -> String {
    String::from_utf8(bytes(name)).unwrap()
}

/// Asserts that a file has the contents of another, with a note that contains `note`.
fn reads_as(name: &str, other: &str, note: &str) {
    let (own, rows) = read_bytes(&bytes(name), None).unwrap();
    let (opened, read) = read_bytes(other.as_bytes(), None).unwrap();
    assert_eq!((&opened.columns, read), (&own.columns, rows), "{note}");
    assert!(opened.notes.iter().any(|found| found.contains(note)), "{:?}", opened.notes);
}

fn fault(text: &str) -> String {
    read_bytes(text.as_bytes(), None).err().unwrap()
}

#[test]
fn semicolons_and_tabs_may_stand_for_commas() {
    for name in ["windows.csv", "legacy.csv"] {
        reads_as(name, &text(name).replace(',', ";"), "separated by ; instead of commas");
        reads_as(name, &text(name).replace(',', "\t"), "separated by tabs instead of commas");
    }
}

#[test]
fn empty_fields_at_the_end_of_lines_are_left_out() {
    let note = "empty fields at the end of lines are left out";
    for name in ["windows.csv", "legacy.csv", "system_ila.csv"] {
        reads_as(name, &text(name).replace('\n', ",,\n"), note);
        let (head, rows) =
            text(name).split_once('\n').map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
        reads_as(name, &format!("{head}\n{}", rows.replace('\n', ",\n")), note);
    }
}

#[test]
fn a_byte_order_mark_may_stand_before_a_quoted_head() {
    let quoted: String = text("windows.csv")
        .lines()
        .map(|line| {
            line.split(',').map(|cell| format!("\"{cell}\"")).collect::<Vec<_>>().join(";") + "\r\n"
        })
        .collect();
    let marked = format!("\u{feff}{quoted}");
    reads_as("windows.csv", &marked, "quotes say nothing");
    reads_as("windows.csv", &marked, "a byte order mark");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("marked.csv");
    std::fs::write(&path, marked).unwrap();
    assert_eq!(Source::file(&path, None).unwrap().format, SourceFormat::IlaCsv);
}

#[test]
fn words_may_have_lost_their_quotes() {
    let bare = text("system_ila.csv").replace("\"First, and only\"", "\"First\"");
    let (_, rows) = read_bytes(bare.as_bytes(), None).unwrap();
    let (opened, read) = read_bytes(bare.replace('"', "").as_bytes(), None).unwrap();
    assert_eq!(read, rows);
    let note = "slot_0_axis_status: 2 cells are words without quotes, the first `_` in line 3";
    assert_eq!(opened.notes[0], note);
}

#[test]
fn what_is_no_row_of_a_capture_is_refused_with_the_line() {
    let windows = text("windows.csv");
    let (head, rows) = windows.split_once("\n3,").unwrap();
    let with = |line: &str| fault(&format!("{head}\n{line}\n3,{rows}"));
    let merge = with("<<<<<<< HEAD");
    assert!(merge.contains(": <<<<<<< HEAD: too few fields: 1, expected"), "{merge}");
    let fields = head.lines().next().unwrap().split(',').count();
    let row = with(&format!("the laser fires here{}", ",".repeat(fields - 1)));
    assert!(
        row.contains("Sample in Buffer = the laser fires here: expected a whole number"),
        "{row}"
    );
    let many = with(&format!("note{}", ",x".repeat(fields)));
    assert!(many.contains(": note,x") && many.contains("too many fields"), "{many}");
}
