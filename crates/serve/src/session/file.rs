//! Files that a browser saves.

use std::sync::Arc;

use tofsim::WaveFormat;
use tofsim_captures::ila::export::CaptureFormat;

/// A file to save.
#[derive(Clone, Debug)]
pub struct File {
    /// File name, of letters, digits, `_`, `-` and `.`.
    pub name: String,
    /// Media type.
    pub media_type: &'static str,
    /// Contents.
    pub bytes: Arc<[u8]>,
}

impl File {
    /// Creates a file of a capture.
    pub fn of_capture(name: String, format: CaptureFormat, bytes: Arc<[u8]>) -> Self {
        let media_type = match format {
            CaptureFormat::Csv => "text/csv; charset=utf-8",
            CaptureFormat::Vcd => "text/plain; charset=utf-8",
            CaptureFormat::Ila => "application/zip",
        };
        File { name, media_type, bytes }
    }

    /// Creates a waveform file.
    pub fn of_waves(format: WaveFormat, bytes: Vec<u8>) -> Self {
        let (name, media_type) = match format {
            WaveFormat::Vcd => ("shot.vcd", "text/plain; charset=utf-8"),
            WaveFormat::Fst => ("shot.fst", "application/octet-stream"),
        };
        File { name: name.to_owned(), media_type, bytes: bytes.into() }
    }

    /// Creates a scenario file, named after the original scenario.
    pub fn of_scenario(name: &str, text: String) -> Self {
        let known = |c: char| if c.is_ascii_alphanumeric() || "_-".contains(c) { c } else { '_' };
        let name: String = name.chars().map(known).collect();
        let bytes = text.into_bytes().into();
        File { name: format!("{name}_run.toml"), media_type: "text/plain; charset=utf-8", bytes }
    }
}
