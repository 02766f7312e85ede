//! A capture that is read: its columns, and its samples one after the other.

use std::io;

use tofsim::error::{Error, Input, Result};

use super::super::capture::Radix;

/// Widest probe [bits].
pub const WIDEST_PROBE: u32 = 4096;
/// Widest sample [bits].
pub const WIDEST_SAMPLE: u32 = 1 << 20;
/// Largest capture, more than any FPGA's block RAM holds [bits].
pub const LARGEST: u64 = 1 << 29;

/// A column of a capture: a probe, or a slice of one.
#[derive(Clone, Debug, PartialEq, Eq)]
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
    /// Whether it holds words instead of numbers. These are not read.
    pub text: bool,
    /// First word of its place in a row; words of text have none.
    pub word: usize,
}

impl Column {
    /// Words of its place in a row.
    pub fn words(&self) -> usize {
        if self.text { 0 } else { self.width.div_ceil(64) as usize }
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
}

/// An error of reading an entry.
pub(super) fn damaged(source: &str, error: io::Error) -> Error {
    Input::new(source, format!("damaged: {error}")).into()
}
