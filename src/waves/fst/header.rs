//! The header of an FST file. It has a fixed length and is written twice: at first to reserve the space, and again
//! once the end is known.

use std::io::{self, Seek, SeekFrom, Write};

use crate::error::Result;
use crate::files::date;

use super::blocks::{Block, long};

/// Size of the version field, including a final zero [bytes].
const VERSION: usize = 128;
/// Size of the date field [bytes].
const DATE: usize = 119;
/// Exponent of the time unit of tofsim's own files: picoseconds.
const PICOSECOND: i8 = -12;
/// File type of a Verilog simulator.
const VERILOG: u8 = 0;

/// Contents of the header.
#[derive(Clone, Debug, Default)]
pub(super) struct Header {
    /// Exponent of the time unit, a power of ten [s].
    pub(super) exponent: i8,
    /// Start time, in units.
    pub(super) start: u64,
    /// End time, in units.
    pub(super) end: u64,
    pub(super) scopes: u64,
    /// Number of names, including aliases.
    pub(super) names: u64,
    /// Number of signals.
    pub(super) signals: u64,
    /// Number of sections of value changes.
    pub(super) sections: u64,
    /// Program, version and provenance.
    pub(super) version: String,
    /// Date, if the environment sets one.
    pub(super) date: String,
}

impl Header {
    /// Creates a header with the program, its version and the provenance.
    pub(super) fn new(provenance: &[String]) -> Result<Self> {
        let date = date::fixed()?.unwrap_or_default();
        let (exponent, version) = (PICOSECOND, version(provenance));
        Ok(Header { exponent, version, date, ..Header::default() })
    }

    /// Writes the header at the start of a file.
    pub(super) fn write(&self, file: &mut (impl Write + Seek)) -> io::Result<()> {
        let mut contents = Vec::new();
        for time in [self.start, self.end] {
            long(&mut contents, time);
        }
        // By this number a reader sees in which order the bytes of floating point are.
        contents.extend_from_slice(&std::f64::consts::E.to_le_bytes());
        let memory_of_writer = 0;
        for count in [memory_of_writer, self.scopes, self.names, self.signals, self.sections] {
            long(&mut contents, count);
        }
        contents.extend_from_slice(&self.exponent.to_be_bytes());
        text(&mut contents, &self.version, VERSION);
        text(&mut contents, &self.date, DATE);
        contents.push(VERILOG);
        let time_zero = 0;
        long(&mut contents, time_zero);
        file.seek(SeekFrom::Start(0))?;
        Block::Header.write(file, &[&contents])
    }
}

/// Appends a text, padded with zeros to a length.
fn text(bytes: &mut Vec<u8>, text: &str, length: usize) {
    let end = bytes.len() + length;
    bytes.extend_from_slice(text.as_bytes());
    bytes.resize(end, 0);
}

/// Formats program and version, and the lines of the provenance as far as the field has room for whole ones.
fn version(provenance: &[String]) -> String {
    let program = concat!("tofsim ", env!("CARGO_PKG_VERSION"));
    let mut version = program.to_owned();
    for line in provenance.iter().skip_while(|line| *line == program) {
        let line = line.replace('\0', " ");
        if version.len() + "; ".len() + line.len() >= VERSION {
            break;
        }
        version = format!("{version}; {line}");
    }
    version
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    #[test]
    fn whole_lines_of_the_provenance_go_into_the_version_as_far_as_they_fit() {
        let short = version(&["scenario kc705".into(), "seed 1".into()]);
        assert!(short.starts_with("tofsim ") && short.ends_with("; scenario kc705; seed 1"));
        let own = version(&[]);
        assert_eq!(version(&[own.clone(), "seed 1".into()]), format!("{own}; seed 1"));
        let room = VERSION - 1 - own.len() - "; ".len();
        assert_eq!(version(&["a".repeat(room)]).len(), VERSION - 1);
        assert_eq!(version(&["seed 1".into(), "a".repeat(room)]), format!("{own}; seed 1"));
    }

    #[test]
    fn a_header_that_is_written_again_takes_the_same_place() {
        let mut file = Cursor::new(Vec::new());
        let mut header = Header::new(&["scenario kc705".into()]).unwrap();
        header.write(&mut file).unwrap();
        file.write_all(b"what follows").unwrap();
        header = Header { end: u64::MAX, sections: 9, ..header };
        header.write(&mut file).unwrap();
        let bytes = file.into_inner();
        assert!(bytes.len() == 330 + 12 && bytes.ends_with(b"\0what follows"));
    }
}
