//! First pass over a CSV, which finds columns of words, and the radices of other columns if the file does not state
//! them.
//!
//! Vivado puts words in quotes, which spreadsheets remove. An unquoted cell is therefore a word too if it begins as a
//! name does and cannot be a number. In a file with quotes around everything, quotes have no meaning.

use std::io::Read;

use tofsim::error::{Input, Result};

use super::super::capture::Radix;
use super::heads::{FIXED, Heads, TRAIL};
use super::infer::Guess;
use super::opened::lay_out;
use super::table::{Row, Table};

/// Findings about a column.
struct Found {
    guess: Guess,
    /// Whether there are words, and numbers.
    words: bool,
    numbers: bool,
    /// Number of unquoted words, and the first of them.
    bare: u64,
    first_bare: Option<Input>,
}

/// Reads the rest of `table`, and stores the types of the columns in `heads`. `hint` decides between several possible
/// radices.
pub(super) fn survey(
    table: &mut Table<impl Read>,
    heads: &mut Heads,
    hint: Option<Radix>,
) -> Result<()> {
    let first = FIXED.len() + usize::from(heads.gap);
    let fields = first + heads.columns.len();
    let new = |_| Found {
        guess: Guess::new(hint),
        words: false,
        numbers: false,
        bare: 0,
        first_bare: None,
    };
    let mut found: Vec<Found> = (0..heads.columns.len()).map(new).collect();
    let mut all_quoted = false;
    while table.advance_to(fields)? {
        let row = &table.row;
        // Vivado never quotes the number of a sample.
        let quoted = row.is_quoted(0);
        all_quoted |= quoted;
        for (index, (column, found)) in heads.columns.iter_mut().zip(&mut found).enumerate() {
            let index = first + index;
            let has_quotes = row.is_quoted(index) && !quoted;
            if column.text || has_quotes || is_name(row, index, column.radix) {
                found.words = true;
                if !has_quotes && !column.text {
                    found.bare += 1;
                    let fault = || row.fault(index, "").field(column.head());
                    found.first_bare.get_or_insert_with(fault);
                }
                column.learn(&row.text(index)?, None);
                continue;
            }
            found.numbers = true;
            if !heads.radix_row {
                found.guess.take(row, index, column)?;
            }
        }
    }
    if table.trails && !heads.notes.iter().any(|note| note == TRAIL) {
        heads.notes.push(TRAIL.to_owned());
    }
    if all_quoted {
        heads.notes.push("quotes say nothing: there are some around numbers too".to_owned());
    }
    for (column, found) in heads.columns.iter_mut().zip(found) {
        if !heads.radix_row && (found.numbers || !found.words) {
            column.radix = Some(found.guess.decide(hint)?);
        }
        column.text |= found.words;
        column.mixed = column.text && found.numbers;
        if let Some(Input { place: Some((line, _)), value: Some(value), .. }) = found.first_bare {
            let (head, count) = (column.head(), found.bare);
            heads.notes.push(format!(
                "{head}: {count} cells are words without quotes, the first `{value}` in line {line}"
            ));
        }
    }
    lay_out(&mut heads.columns);
    Ok(())
}

/// Returns whether a cell begins as a name does and is not a number, neither hexadecimal nor unknown.
fn is_name(row: &Row, index: usize, radix: Option<Radix>) -> bool {
    let cell = row.field(index);
    let begins = cell.first().is_some_and(|&byte| byte.is_ascii_alphabetic() || byte == b'_');
    let is_hex = matches!(radix, None | Some(Radix::Hex));
    let digit = |byte: &u8| (is_hex && byte.is_ascii_hexdigit()) || matches!(byte, b'x' | b'X');
    begins && !cell.iter().all(digit)
}
