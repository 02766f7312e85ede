//! Files that a browser saves.

use std::sync::Arc;

use tofsim::WaveFormat;
use tofsim_captures::ila::export::CaptureFormat;

/// A file to save.
#[derive(Clone, Debug)]
pub struct File {
    /// Its name, of letters, digits, `_`, `-` and `.`.
    pub name: String,
    /// Its media type.
    pub media_type: &'static str,
    /// What is in it.
    pub bytes: Arc<[u8]>,
}

impl File {
    /// A file of a capture.
    pub fn of_capture(name: String, format: CaptureFormat, bytes: Arc<[u8]>) -> Self {
        let media_type = match format {
            CaptureFormat::Csv => "text/csv; charset=utf-8",
            CaptureFormat::Vcd => "text/plain; charset=utf-8",
            CaptureFormat::Ila => "application/zip",
        };
        File { name, media_type, bytes }
    }

    /// A waveform.
    pub fn of_waves(format: WaveFormat, bytes: Vec<u8>) -> Self {
        let (name, media_type) = match format {
            WaveFormat::Vcd => ("shot.vcd", "text/plain; charset=utf-8"),
            WaveFormat::Fst => ("shot.fst", "application/octet-stream"),
        };
        File { name: name.to_owned(), media_type, bytes: bytes.into() }
    }

    /// A scenario, named after the one that it was.
    pub fn of_scenario(name: &str, text: String) -> Self {
        let known = |c: char| if c.is_ascii_alphanumeric() || "_-".contains(c) { c } else { '_' };
        let name: String = name.chars().map(known).collect();
        let bytes = text.into_bytes().into();
        File { name: format!("{name}_run.toml"), media_type: "text/plain; charset=utf-8", bytes }
    }
}
