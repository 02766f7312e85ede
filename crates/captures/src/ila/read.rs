//! Reader of captures written by Vivado and by AMD's chipscopy: CSV with or without a row of radices, and the
//! archive. The format is detected by content, not by name.

mod archive;
mod buffer;
mod csv;
pub(crate) mod digits;
mod dump;
mod header;
mod infer;
mod line;
mod ltx;
mod opened;
mod order;
mod survey;
mod table;
mod vcd;

use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;
use std::sync::atomic::AtomicBool;

use tofsim::error::{Error, Result};

use super::capture::Radix;

pub use opened::{
    CaptureForm, CaptureRow, CaptureRows, Column, LARGEST, LONGEST_WORD, NamedValue, Opened,
    WIDEST_PROBE, WIDEST_SAMPLE,
};
pub(crate) use opened::{MOST_STATES, put_word, word};

/// Opens a capture. `radix` applies to a CSV without radices that can be read in several ways.
///
/// # Errors
/// When the file cannot be read or is no capture, and [`Error::Interrupted`] once `stop` is set.
pub fn open(path: &Path, radix: Option<Radix>, stop: Option<&AtomicBool>) -> Result<Opened> {
    let fault = || Error::io(path, "read");
    let mut file = File::open(path).map_err(fault())?;
    let mut start = Vec::new();
    file.by_ref().take(2).read_to_end(&mut start).map_err(fault())?;
    file.rewind().map_err(fault())?;
    let source = path.display().to_string();
    if start == b"PK" {
        archive::open(source, file, radix, stop)
    } else {
        csv::open(source, file, radix, stop)
    }
}
