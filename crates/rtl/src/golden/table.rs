//! Lines of bits: what goes into a block, or comes out of it, clock by clock.

use std::io::{self, Write};

use bitvec::prelude::*;

use tofsim::kernel::Thermometer;
use tofsim::kernel::signals::Sink;
use tofsim::waves::{Bits, TapDigits};

/// A place in every line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Port, or path of a register inside the block.
    pub name: String,
    /// Its width [bits].
    pub width: usize,
    /// Lowest bit of its place.
    pub low: usize,
    /// Sample of the clock cycle, from 0.
    pub sample: usize,
    /// A register inside, which another implementation need not have.
    pub internal: bool,
}

impl Column {
    /// A port that is seen in the first sample of a cycle; [`Table::new`] gives it its place.
    pub fn new(name: impl Into<String>, width: u32) -> Self {
        Column { name: name.into(), width: width as usize, low: 0, sample: 0, internal: false }
    }
}

/// Lines of equal columns; the first column is in the top bits.
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<Column>,
    width: usize,
    rows: usize,
    /// Lines so far, each in whole words, the lowest first.
    words: Vec<u64>,
    /// Line under construction.
    line: Vec<u64>,
}

impl Table {
    /// No lines yet; the places of the columns are worked out here.
    pub fn new(mut columns: Vec<Column>) -> Self {
        let mut width = 0;
        for column in columns.iter_mut().rev() {
            column.low = width;
            width += column.width;
        }
        let line = vec![0; width.div_ceil(64)];
        Table { columns, width, rows: 0, words: Vec::new(), line }
    }

    /// The columns, in order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Bits of a line.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Lines so far.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Writes a word into the line under construction.
    pub fn set(&mut self, column: usize, value: u64) {
        let Column { low, width, .. } = self.columns[column];
        put(&mut self.line, low, width, value);
    }

    /// Writes bits into the line under construction, the first one lowest.
    pub fn set_bits(&mut self, column: usize, bits: Bits) {
        let Column { low, width, .. } = self.columns[column];
        for (place, word) in (0..width).step_by(64).zip(bits.words) {
            put(&mut self.line, low + place, (width - place).min(64), *word);
        }
    }

    /// Ends the line; the next one begins with its values.
    pub fn push(&mut self) {
        self.words.extend_from_slice(&self.line);
        self.rows += 1;
    }

    /// A line.
    pub fn row(&self, row: usize) -> &BitSlice<u64, Lsb0> {
        &self.words_of(row).view_bits()[..self.width]
    }

    /// A value in hexadecimal, all digits.
    pub fn hex(&self, row: usize, column: usize) -> String {
        let Column { low, width, .. } = self.columns[column];
        hex(&self.row(row)[low..low + width])
    }

    /// The lines for `$readmemh`; an empty line is the digit 0.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        for row in 0..self.rows {
            writeln!(out, "{}", digits(self.words_of(row), self.width))?;
        }
        Ok(())
    }

    /// The words of a line.
    fn words_of(&self, row: usize) -> &[u64] {
        &self.words[row * self.line.len()..][..self.line.len()]
    }
}

/// Replaces up to 64 bits from `low` on by the lowest of `value`.
///
/// By words: lines take most of the time of recording, and a bit slice's place costs more than the store.
fn put(words: &mut [u64], low: usize, width: usize, value: u64) {
    if width == 0 {
        return;
    }
    let (word, bit) = (low / 64, low % 64);
    let mask = u64::MAX >> (64 - width);
    let value = value & mask;
    words[word] = words[word] & !(mask << bit) | value << bit;
    if bit + width > 64 {
        let rest = 64 - bit;
        words[word + 1] = words[word + 1] & !(mask >> rest) | value >> rest;
    }
}

/// Bits in hexadecimal, all digits, at least one.
pub fn hex(bits: &BitSlice<u64, Lsb0>) -> String {
    let words: Vec<u64> = bits.chunks(64).map(|word| word.load_le()).collect();
    digits(&words, bits.len())
}

/// So many bits of words in hexadecimal, the lowest word first; all digits, at least one.
fn digits(words: &[u64], width: usize) -> String {
    let digit = |place: usize| {
        let word = words.get(place / 16).copied().unwrap_or_default();
        char::from(b"0123456789abcdef"[(word >> (4 * (place % 16)) & 15) as usize])
    };
    (0..width.div_ceil(4).max(1)).rev().map(digit).collect()
}

/// Puts reported signals into the line under construction.
pub struct LineSink<'a> {
    /// Table that takes the values.
    pub table: &'a mut Table,
    /// Columns of each id.
    pub places: &'a [Vec<usize>],
    /// Shows taps in their physical places.
    pub taps: &'a mut TapDigits,
}

impl Sink for LineSink<'_> {
    fn word(&mut self, id: usize, value: u64) {
        for &column in &self.places[id] {
            self.table.set(column, value);
        }
    }

    fn taps(&mut self, id: usize, value: &Thermometer, group: usize) {
        for &column in &self.places[id] {
            self.table.set_bits(column, self.taps.bits(value, group));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_column_is_on_top_and_a_line_begins_with_the_last_one_s_values() {
        let mut table =
            Table::new([("a", 1), ("b", 8), ("c", 36)].map(|(a, b)| Column::new(a, b)).into());
        table.set(0, 1);
        table.set(1, 0xa5);
        table.set(2, 0xf_0000_0001);
        table.push();
        table.set(0, 0);
        table.push();
        let mut text = Vec::new();
        table.write(&mut text).unwrap();
        assert_eq!(String::from_utf8(text).unwrap(), "1a5f00000001\n0a5f00000001\n");
        assert_eq!(table.hex(1, 2), "f00000001");
    }

    #[test]
    fn a_word_replaces_only_its_bits_wherever_it_lies() {
        for (low, width) in [(0, 64), (3, 1), (60, 4), (60, 5), (63, 64), (64, 64), (37, 0)] {
            for before in [0, u64::MAX] {
                let mut expected = bitvec![u64, Lsb0; 0; 192];
                expected.as_raw_mut_slice().fill(before);
                let mut found = expected.clone();
                put(found.as_raw_mut_slice(), low, width, 0xdead_beef_0123_4567);
                if width > 0 {
                    expected[low..low + width].store_le(0xdead_beef_0123_4567_u64);
                }
                assert_eq!(found, expected, "{width} bits at {low}");
            }
        }
    }

    #[test]
    fn a_line_without_columns_is_a_zero() {
        let mut table = Table::new(Vec::new());
        table.push();
        let mut text = Vec::new();
        table.write(&mut text).unwrap();
        assert_eq!(text, b"0\n");
    }
}
