//! A capture that is read: its columns, and its samples one after the other.

use std::io;
use std::ops::Range;

use tofsim::error::{Error, Input, Result};

use super::super::capture::Radix;

/// Widest probe [bits].
pub const WIDEST_PROBE: u32 = 4096;
/// Widest sample [bits].
pub const WIDEST_SAMPLE: u32 = 1 << 20;
/// Largest capture, more than any FPGA's block RAM holds [bits].
pub const LARGEST: u64 = 1 << 29;
/// Longest word in a cell [bytes].
pub const LONGEST_WORD: usize = 128;
/// Most words of a column that are kept.
const MOST_STATES: usize = 256;

/// A column of a capture: a probe, or a slice of one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Column {
    /// Name without its range.
    pub name: String,
    /// Width [bits].
    pub width: u32,
    /// Index of its lowest bit.
    pub lsb: u32,
    /// Whether it has a range, even of one bit.
    pub vector: bool,
    /// How its values are shown; none if the file does not tell.
    pub radix: Option<Radix>,
    /// Whether its cells are words, or words among numbers, of which the bits are not known. A
    /// row then has the bytes of the cell, the first lowest.
    pub text: bool,
    /// Whether there are numbers among the words.
    pub mixed: bool,
    /// The words in the file, with their bits if the file tells these.
    pub states: Vec<State>,
    /// First word of its place in a row.
    pub word: usize,
}

/// A word that stands for a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    /// The word.
    pub name: String,
    /// The value, if it is known.
    pub bits: Option<u64>,
}

impl Column {
    /// Bits of its place in a row.
    pub fn bits(&self) -> u32 {
        if self.text { 8 * LONGEST_WORD as u32 } else { self.width }
    }

    /// Words of its place in a row.
    pub fn words(&self) -> usize {
        self.bits().div_ceil(64) as usize
    }

    /// Its place in a row.
    pub fn place(&self) -> Range<usize> {
        self.word..self.word + self.words()
    }

    /// Keeps a word that is in the file, the first of them only.
    pub(super) fn learn(&mut self, name: &str, bits: Option<u64>) {
        if self.states.len() < MOST_STATES && self.states.iter().all(|known| known.name != name) {
            self.states.push(State { name: name.to_owned(), bits });
        }
    }

    /// Name and range, as the head of a column has them.
    pub fn head(&self) -> String {
        match self.vector {
            true => format!("{}[{}:{}]", self.name, self.lsb + (self.width - 1), self.lsb),
            false => self.name.clone(),
        }
    }
}

/// A sample.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CaptureRow {
    /// Its number in the buffer.
    pub sample: u64,
    /// Its number in its window.
    pub in_window: u64,
    /// Whether a window begins here.
    pub window_start: bool,
    /// Whether it triggered.
    pub trigger: bool,
    /// Whether nothing was stored here.
    pub gap: bool,
    /// The values; each column begins at a word of its own.
    pub value: Vec<u64>,
    /// 1 where a bit of the value is not known.
    pub unknown: Vec<u64>,
}

impl CaptureRow {
    /// Makes room for the values of those columns, all 0.
    pub(super) fn clear(&mut self, columns: &[Column]) {
        let words = columns.last().map_or(0, |last| last.word + last.words());
        for place in [&mut self.value, &mut self.unknown] {
            place.clear();
            place.resize(words, 0);
        }
    }
}

/// The samples of a file, one after the other.
pub trait CaptureRows: Send {
    /// Reads the next row into `row`; false at the end. A row that is wrong is an error.
    fn next(&mut self, row: &mut CaptureRow) -> Result<bool>;
}

/// The form of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CaptureForm {
    /// CSV with a row of radices.
    Csv,
    /// CSV without that row.
    LegacyCsv,
    /// Vivado's archive.
    Archive,
}

/// A file whose head has been read.
pub struct Opened {
    /// Its form.
    pub form: CaptureForm,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Whether the file tells the radices; otherwise they were inferred, or there are none.
    pub radix_told: bool,
    /// The samples.
    pub rows: Box<dyn CaptureRows>,
    /// What was read otherwise than it is written by Vivado, or taken from another part.
    pub notes: Vec<String>,
}

/// Gives each column its place in a row.
pub(super) fn lay_out(columns: &mut [Column]) {
    let mut word = 0;
    for column in columns {
        column.word = word;
        word += column.words();
    }
}

/// The bytes of a word as the value of a column of text.
pub(super) fn put_word(cell: &[u8], place: &mut [u64]) {
    for (k, &byte) in cell.iter().enumerate() {
        place[k / 8] |= u64::from(byte) << (8 * (k % 8));
    }
}

/// The word that a value of a column of text is.
pub(crate) fn word(value: &[u64]) -> String {
    let bytes: Vec<u8> = value.iter().flat_map(|word| word.to_le_bytes()).collect();
    let end = bytes.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

/// An error of reading an entry.
pub(super) fn damaged(source: &str, error: io::Error) -> Error {
    Input::new(source, format!("damaged: {error}")).into()
}
