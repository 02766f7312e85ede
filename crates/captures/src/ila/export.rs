//! Export of a capture to files.

use std::io;
use std::path::{Path, PathBuf};

use strum::{Display, VariantArray};

use tofsim::error::Result;
use tofsim::files::output::{create_directory, write_file};

use super::capture::Capture;
use super::write;

/// A file format of Vivado's `write_hw_ila_data`. Its text is the file name extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Display, VariantArray)]
#[strum(serialize_all = "lowercase")]
pub enum CaptureFormat {
    /// One row per sample
    Csv,
    /// Value change dump, with sample numbers as times
    Vcd,
    /// Vivado's archive
    Ila,
}

impl CaptureFormat {
    /// All formats.
    pub const ALL: &[CaptureFormat] = CaptureFormat::VARIANTS;
}

/// Writes a capture to `folder` in each of the formats, as `stem` with the format's extension, and returns the paths.
/// `radix_row` selects whether the CSV has a second row with radices.
///
/// # Errors
/// If a file cannot be written.
pub fn export(
    capture: &Capture,
    folder: &Path,
    stem: &str,
    formats: &[CaptureFormat],
    radix_row: bool,
) -> Result<Vec<PathBuf>> {
    create_directory(folder)?;
    let mut paths = Vec::new();
    for format in CaptureFormat::ALL.iter().filter(|format| formats.contains(format)) {
        let path = folder.join(format!("{stem}.{format}"));
        write_file(&path, |out| -> io::Result<()> {
            match format {
                CaptureFormat::Csv => write::csv(out, capture, radix_row),
                CaptureFormat::Vcd => write::vcd(out, capture),
                CaptureFormat::Ila => write::archive(out, capture),
            }
        })?;
        paths.push(path);
    }
    Ok(paths)
}
