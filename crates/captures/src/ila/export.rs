//! The files of a capture.

use std::io;
use std::path::{Path, PathBuf};

use tofsim::error::Result;
use tofsim::files::output::{create_directory, write_file};

use super::capture::Capture;
use super::write;

/// One of the forms that Vivado's `write_hw_ila_data` has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CaptureFormat {
    /// A row for each sample
    Csv,
    /// Value change dump, its time the number of the sample
    Vcd,
    /// Vivado's own archive
    Ila,
}

impl CaptureFormat {
    /// All of them.
    pub const ALL: [CaptureFormat; 3] =
        [CaptureFormat::Csv, CaptureFormat::Vcd, CaptureFormat::Ila];

    /// Ending of a file's name.
    pub const fn ending(self) -> &'static str {
        match self {
            CaptureFormat::Csv => "csv",
            CaptureFormat::Vcd => "vcd",
            CaptureFormat::Ila => "ila",
        }
    }
}

/// Writes a capture into `folder`, in each format once, as `stem` with the format's ending; `radix_row`
/// is the second row of the CSV. Returns the paths.
///
/// # Errors
/// When a file cannot be written.
pub fn export(
    capture: &Capture,
    folder: &Path,
    stem: &str,
    formats: &[CaptureFormat],
    radix_row: bool,
) -> Result<Vec<PathBuf>> {
    create_directory(folder)?;
    let mut paths = Vec::new();
    for format in CaptureFormat::ALL.into_iter().filter(|format| formats.contains(format)) {
        let path = folder.join(format!("{stem}.{}", format.ending()));
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
