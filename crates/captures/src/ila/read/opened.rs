//! An opened capture: its columns, and an iterator over its samples.

use std::io;
use std::ops::Range;

use tofsim::error::{Error, Input, Result};

use super::super::capture::Radix;

/// Widest probe [bits].
pub const WIDEST_PROBE: u32 = 4096;
/// Widest sample [bits].
pub const WIDEST_SAMPLE: u32 = 1 << 20;
/// Size limit of a capture, larger than any FPGA's block RAM [bits].
pub const LARGEST: u64 = 1 << 29;
/// Longest word in a cell [bytes].
pub const LONGEST_WORD: usize = 128;
/// Largest number of distinct words of a signal that are kept.
pub(crate) const MOST_STATES: usize = 256;

/// A column of a capture: a probe, or a slice of one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Column {
    /// Name without range.
    pub name: String,
    /// Width [bits].
    pub width: u32,
    /// Index of the lowest bit.
    pub lsb: u32,
    /// Whether the name has a range, even for one bit.
    pub vector: bool,
    /// Radix of the values; `None` if the file does not state it.
    pub radix: Option<Radix>,
    /// Whether cells are words, possibly among numbers, whose values are unknown. A row then has the bytes of the
    /// cell, first one lowest.
    pub text: bool,
    /// Whether there are numbers among the words.
    pub mixed: bool,
    /// Words in the file, with their values if the file states them.
    pub states: Vec<NamedValue>,
    /// Index of its first word in a row.
    pub word: usize,
}

/// A word that represents a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedValue {
    /// Text of the word.
    pub name: String,
    /// Value, if it is known.
    pub bits: Option<u64>,
}

impl Column {
    /// Returns the number of bits that it uses in a row.
    pub fn bits(&self) -> u32 {
        if self.text { 8 * LONGEST_WORD as u32 } else { self.width }
    }

    /// Returns the number of words that it uses in a row.
    pub fn words(&self) -> usize {
        self.bits().div_ceil(64) as usize
    }

    /// Returns the range of its words in a row.
    pub fn place(&self) -> Range<usize> {
        self.word..self.word + self.words()
    }

    /// Stores a word of the file, unless there are too many.
    pub(super) fn learn(&mut self, name: &str, bits: Option<u64>) {
        if self.states.len() < MOST_STATES && self.states.iter().all(|known| known.name != name) {
            self.states.push(NamedValue { name: name.to_owned(), bits });
        }
    }

    /// Returns name and range, as in the head of a column.
    pub fn head(&self) -> String {
        if self.vector {
            format!("{}[{}:{}]", self.name, self.lsb + (self.width - 1), self.lsb)
        } else {
            self.name.clone()
        }
    }
}

/// A sample.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CaptureRow {
    /// Sample number in the buffer.
    pub sample: u64,
    /// Sample number in the window.
    pub in_window: u64,
    /// Whether a window begins with this sample.
    pub window_start: bool,
    /// Whether this sample triggered.
    pub trigger: bool,
    /// Whether this sample was not stored.
    pub gap: bool,
    /// Values; each column begins at a word boundary.
    pub value: Vec<u64>,
    /// Mask of the unknown bits.
    pub unknown: Vec<u64>,
}

impl CaptureRow {
    /// Sets all values to 0, with room for the given columns.
    pub(super) fn clear(&mut self, columns: &[Column]) {
        let words = columns.last().map_or(0, |last| last.word + last.words());
        for place in [&mut self.value, &mut self.unknown] {
            place.clear();
            place.resize(words, 0);
        }
    }
}

/// Iterator over the samples of a file.
pub trait CaptureRows: Send {
    /// Reads the next row into `row`; returns false at the end.
    ///
    /// # Errors
    /// If the row is invalid.
    fn next(&mut self, row: &mut CaptureRow) -> Result<bool>;
}

/// File format of a capture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CaptureForm {
    /// CSV with a row of radices.
    Csv,
    /// CSV without a row of radices.
    LegacyCsv,
    /// Vivado's archive.
    Archive,
}

/// A capture whose header has been read.
pub struct Opened {
    /// File format.
    pub form: CaptureForm,
    /// Columns.
    pub columns: Vec<Column>,
    /// Whether the file states the radices; otherwise they were inferred, or there are none.
    pub radix_stated: bool,
    /// Samples.
    pub rows: Box<dyn CaptureRows>,
    /// Notes on deviations from Vivado's format, and on values taken from another part.
    pub notes: Vec<String>,
}

/// Assigns each column its words in a row.
pub(super) fn lay_out(columns: &mut [Column]) {
    let mut word = 0;
    for column in columns {
        column.word = word;
        word += column.words();
    }
}

/// Stores the bytes of a word as the value of a text column.
pub(crate) fn put_word(cell: &[u8], place: &mut [u64]) {
    for (k, &byte) in cell.iter().enumerate() {
        place[k / 8] |= u64::from(byte) << (8 * (k % 8));
    }
}

/// Converts the value of a text column to a word.
pub(crate) fn word(value: &[u64]) -> String {
    let bytes: Vec<u8> = value.iter().flat_map(|word| word.to_le_bytes()).collect();
    let end = bytes.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

/// Creates the error for an unreadable entry.
pub(super) fn damaged(source: &str, error: io::Error) -> Error {
    Input::new(source, format!("damaged: {error}")).into()
}
