//! What the bench saw, line by line, beside what it should have seen.

use std::path::Path;

use comfy_table::Table as Text;

use crate::error::{Input, Result, read_text};
use crate::golden::Vectors;
use crate::golden::table::{Column, Table};
use crate::report::table::plain;

use super::verdict::Mismatch;

/// The lines that a bench writes with `+got=`.
#[derive(Clone, Debug)]
pub struct Seen(Vec<String>);

/// Cycles shown before and after the first mismatch.
const AROUND: usize = 2;
/// Inputs wider than this are not shown [bits].
const WIDEST: usize = 64;

impl Seen {
    /// From the file.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let text = read_text(path)?;
        if text.is_empty() {
            return Err(Input::new(path.display(), "the bench has written nothing").into());
        }
        Ok(Seen(text.lines().map(str::to_owned).collect()))
    }

    /// Lines.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// A value as binary digits, the highest first, with x and z.
    pub fn bits(&self, row: usize, column: &Column) -> String {
        let digits = self.0.get(row).map_or("", String::as_str).trim();
        let nibble = |digit: char| match digit.to_digit(16) {
            Some(value) => format!("{value:04b}"),
            None => String::from(digit.to_ascii_lowercase()).repeat(4),
        };
        let line: String = digits.chars().map(nibble).collect();
        let end = line.len().saturating_sub(column.low);
        let begin = end.saturating_sub(column.width);
        line.get(begin..end).unwrap_or("").to_owned()
    }

    /// The five cycles around the first mismatch: inputs, and both sides of what differs there.
    pub fn around(&self, vectors: &Vectors, first: &Mismatch) -> String {
        let begin = first.cycle.saturating_sub(AROUND);
        let cycles = begin..(first.cycle + AROUND + 1).min(self.len());
        let mut text = plain();
        let head = cycles.clone().map(|cycle| match cycle == first.cycle {
            true => format!("{cycle} *"),
            false => cycle.to_string(),
        });
        text.set_header(["cycle".to_owned(), String::new()].into_iter().chain(head));
        for (k, column) in vectors.stimulus.columns().iter().enumerate() {
            if column.width <= WIDEST {
                let values = cycles.clone().map(|cycle| vectors.stimulus.hex(cycle, k));
                add(&mut text, &column.name, "input", values);
            }
        }
        let expected = &vectors.expected;
        for (k, column) in expected.columns().iter().enumerate() {
            let differs = self.bits(first.cycle, column) != binary(expected, first.cycle, column);
            if differs && column.width <= WIDEST {
                let wanted = cycles.clone().map(|cycle| expected.hex(cycle, k));
                add(&mut text, &column.name, "expected", wanted);
                let got = cycles.clone().map(|cycle| hexadecimal(&self.bits(cycle, column)));
                add(&mut text, &column.name, "got", got);
            }
        }
        text.trim_fmt()
    }
}

fn add(text: &mut Text, name: &str, side: &str, values: impl Iterator<Item = String>) {
    text.add_row([name.to_owned(), side.to_owned()].into_iter().chain(values));
}

/// An expected value as binary digits, the highest first.
pub fn binary(table: &Table, row: usize, column: &Column) -> String {
    let bits = &table.row(row)[column.low..column.low + column.width];
    bits.iter().rev().map(|bit| if *bit { '1' } else { '0' }).collect()
}

/// Binary digits as hexadecimal ones; a digit of which a part is unknown is x.
fn hexadecimal(bits: &str) -> String {
    let padding = (4 - bits.len() % 4) % 4;
    let padded = "0".repeat(padding) + bits;
    let digit = |k: usize| {
        let nibble = &padded[4 * k..4 * k + 4];
        u8::from_str_radix(nibble, 2).map_or("x".to_owned(), |value| format!("{value:x}"))
    };
    (0..padded.len() / 4).map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(width: usize, low: usize) -> Column {
        Column { name: String::new(), width, low, sample: 0, internal: false }
    }

    #[test]
    fn a_column_is_cut_out_of_a_line_with_unknown_bits() {
        let seen = Seen(vec!["0x5".to_owned(), "fff".to_owned()]);
        assert_eq!(seen.bits(0, &column(6, 1)), "xxx010");
        assert_eq!(seen.bits(1, &column(3, 9)), "111");
        assert_eq!(hexadecimal("xxx010"), "xx");
        assert_eq!(hexadecimal("10101"), "15");
        assert_eq!(seen.bits(7, &column(1, 0)), "");
    }
}
