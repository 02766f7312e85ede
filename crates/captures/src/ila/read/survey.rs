//! First pass over a CSV, which finds columns of words, and the radices of other columns if the file does not state
//! them.
//!
//! Vivado puts words in quotes, which spreadsheets remove. An unquoted cell is therefore a word too if it begins as a
//! name does and cannot be a number. In a file with quotes around everything, quotes have no meaning.

use std::io::Read;
use std::sync::atomic::AtomicBool;

use tofsim::error::{Input, Result, poll_stop};

use super::super::capture::Radix;
use super::header::{FIXED, Header, TRAIL};
use super::infer::Guess;
use super::opened::{Column, lay_out};
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

impl Found {
    /// Sets the type of the column, and returns a note on unquoted words.
    fn conclude(
        self,
        column: &mut Column,
        radix_row: bool,
        hint: Option<Radix>,
    ) -> Result<Option<String>> {
        if !radix_row && (self.numbers || !self.words) {
            column.radix = Some(self.guess.decide(hint)?);
        }
        column.text |= self.words;
        column.mixed = column.text && self.numbers;
        let Some(Input { place: Some((line, _)), value: Some(value), .. }) = self.first_bare else {
            return Ok(None);
        };
        let (head, count) = (column.head(), self.bare);
        Ok(Some(format!(
            "{head}: {count} cells are words without quotes, the first `{value}` in line {line}"
        )))
    }
}

/// Reads the rest of `table` until `stop` is set, and stores the types of the columns in `header`. `hint` decides
/// between several possible radices.
pub(super) fn survey(
    table: &mut Table<impl Read>,
    header: &mut Header,
    hint: Option<Radix>,
    stop: Option<&AtomicBool>,
) -> Result<()> {
    let first = FIXED.len() + usize::from(header.gap);
    let fields = first + header.columns.len();
    let new = |_| Found {
        guess: Guess::new(hint),
        words: false,
        numbers: false,
        bare: 0,
        first_bare: None,
    };
    let mut found: Vec<Found> = (0..header.columns.len()).map(new).collect();
    let mut all_quoted = false;
    while table.advance_to(fields)? {
        poll_stop(stop)?;
        let row = &table.row;
        // Vivado never quotes the number of a sample.
        let quoted = row.is_quoted(0);
        all_quoted |= quoted;
        for (index, (column, found)) in header.columns.iter_mut().zip(&mut found).enumerate() {
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
            if !header.radix_row {
                found.guess.take(row, index, column)?;
            }
        }
    }
    if table.trails && !header.notes.iter().any(|note| note == TRAIL) {
        header.notes.push(TRAIL.to_owned());
    }
    if all_quoted {
        header.notes.push("quotes say nothing: there are some around numbers too".to_owned());
    }
    for (column, found) in header.columns.iter_mut().zip(found) {
        header.notes.extend(found.conclude(column, header.radix_row, hint)?);
    }
    lay_out(&mut header.columns);
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
