//! Writer of the `.ila` archive: the other formats in one ZIP file.

use std::io::{self, Seek, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::super::capture::Capture;
use super::csv::csv;
use super::dump::dump;
use super::ltx::ltx;
use super::vcd::vcd;

/// Function that writes one of its files.
type Form = fn(&mut dyn Write, &Capture) -> io::Result<()>;

/// Writes a capture as Vivado's archive. Its entries have no date.
pub fn archive(out: impl Write + Seek, capture: &Capture) -> io::Result<()> {
    let mut zip = ZipWriter::new(out);
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let forms: [(&str, Form); 4] = [
        ("waveform.csv", |out, capture| csv(out, capture, true)),
        ("waveform.vcd", vcd),
        ("waveform.dmp", dump),
        ("probes.ltx", ltx),
    ];
    for (name, form) in forms {
        zip.start_file(name, options)?;
        form(&mut zip, capture)?;
    }
    zip.finish()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Read};

    use super::*;
    use crate::ila::{Probe, Radix};

    fn written() -> Vec<u8> {
        let name = "count".to_owned();
        let probe = Probe { name, width: 8, lsb: 0, vector: true, radix: Radix::Hex };
        let mut capture = Capture::new(vec![probe]);
        capture.words = (0..32).collect();
        capture.windows = vec![0];
        let mut out = Cursor::new(Vec::new());
        archive(&mut out, &capture).unwrap();
        out.into_inner()
    }

    #[test]
    fn an_archive_holds_four_files_that_are_dated_1980() {
        let mut zip = zip::ZipArchive::new(Cursor::new(written())).unwrap();
        assert_eq!(zip.len(), 4);
        for name in ["waveform.csv", "waveform.vcd", "waveform.dmp", "probes.ltx"] {
            let mut entry = zip.by_name(name).unwrap();
            assert_eq!(entry.last_modified().unwrap().year(), 1980);
            let mut text = String::new();
            entry.read_to_string(&mut text).unwrap();
            assert!(text.contains("count") || text.contains("ch[7]"), "{name}: {text}");
        }
    }

    #[test]
    fn the_same_capture_gives_the_same_bytes() {
        assert_eq!(written(), written());
    }
}
