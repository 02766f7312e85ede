//! Reads captures as Vivado (and AMD's chipscopy) writes them: CSV with and without a row of
//! radices, and the archive. A file is told by its content, never by its name.

mod archive;
mod csv;
mod digits;
mod dump;
mod heads;
mod infer;
mod lines;
mod ltx;
mod order;
mod table;

use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use super::capture::Radix;
use tofsim::error::{Error, Result};

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
pub struct Row {
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

impl Row {
    /// Makes room for `words` words, all 0.
    fn clear(&mut self, words: usize) {
        for place in [&mut self.value, &mut self.unknown] {
            place.clear();
            place.resize(words, 0);
        }
    }
}

/// The samples of a file, one after the other.
pub trait Rows: Send {
    /// Reads the next row into `row`; false at the end. A row that is wrong is an error.
    fn next(&mut self, row: &mut Row) -> Result<bool>;
}

/// The form of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
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
    pub form: Form,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Words of a row.
    pub words: usize,
    /// Number of samples, where it is known beforehand.
    pub samples: Option<u64>,
    /// Whether the file tells the radices; otherwise they were inferred, or there are none.
    pub radix_told: bool,
    /// The samples.
    pub rows: Box<dyn Rows>,
}

/// Opens a capture. `radix` decides where a CSV without radices can be read in several ways.
pub fn open(path: &Path, radix: Option<Radix>) -> Result<Opened> {
    let fault = || Error::io(path, "read");
    let mut file = File::open(path).map_err(fault())?;
    let mut start = Vec::new();
    file.by_ref().take(2).read_to_end(&mut start).map_err(fault())?;
    file.rewind().map_err(fault())?;
    let source = path.display().to_string();
    if start == b"PK" { archive::open(source, file, radix) } else { csv::open(source, file, radix) }
}
