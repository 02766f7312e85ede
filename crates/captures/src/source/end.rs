//! How far a waveform goes, which its last change does not tell.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use tofsim::error::{Error, Result};

use super::signals::SourceFormat;

/// Bytes at the end of a VCD in which its last time stamp is looked for.
const TAIL: u64 = 1 << 16;
/// Where an FST file's header has its end: after the block's type and length and the begin.
const FST_END: u64 = 1 + 8 + 8;

/// The last time of a waveform, in its ticks, if it says.
///
/// # Errors
/// When the file cannot be read.
pub(super) fn end(path: &Path, format: SourceFormat) -> Result<Option<u64>> {
    let mut file = File::open(path).map_err(Error::io(path, "read"))?;
    let found = match format {
        SourceFormat::Fst => fst(&mut file),
        SourceFormat::Vcd => vcd(&mut file),
        _ => Ok(None),
    };
    found.map_err(Error::io(path, "read"))
}

fn fst(file: &mut File) -> std::io::Result<Option<u64>> {
    let mut end = [0; 8];
    file.seek(SeekFrom::Start(FST_END))?;
    Ok(file.read_exact(&mut end).is_ok().then_some(u64::from_be_bytes(end)))
}

fn vcd(file: &mut File) -> std::io::Result<Option<u64>> {
    let length = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(length.saturating_sub(TAIL)))?;
    let mut tail = Vec::new();
    file.take(TAIL).read_to_end(&mut tail)?;
    Ok(last_stamp(&String::from_utf8_lossy(&tail), length <= TAIL))
}

/// The last time stamp among the words of a VCD; what is in a comment or names a signal is none.
/// A first word that may be cut off is left out with the next, which it may belong to.
fn last_stamp(text: &str, whole: bool) -> Option<u64> {
    let (text, skipped) = match text.split_once("$enddefinitions") {
        Some((_, changes)) => (changes, 0),
        None => (text, if whole { 0 } else { 2 }),
    };
    let mut words = text.split_ascii_whitespace().skip(skipped);
    let mut last = None;
    while let Some(word) = words.next() {
        if word == "$comment" {
            words.find(|&word| word == "$end");
        } else if word.starts_with(['b', 'B', 'r', 'R', 's', 'S']) {
            words.next();
        } else if let Some(digits) = word.strip_prefix('#') {
            // The last one may be cut off; reading it will tell.
            last = last.max(digits.parse().ok());
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn the_last_time_stamp_of_a_vcd_is_its_end() {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        write!(file, "$end\n#0\n1!\n#700\n0!\nb01 #\n#720\n").unwrap();
        assert_eq!(end(file.path(), SourceFormat::Vcd).unwrap(), Some(720));
        write!(file, "#730 1! #740 0!\nb0 #9\n$comment\n#5\n$end\n").unwrap();
        assert_eq!(end(file.path(), SourceFormat::Vcd).unwrap(), Some(740));
        write!(file, "{}", "1!\n".repeat(40_000)).unwrap();
        assert_eq!(end(file.path(), SourceFormat::Vcd).unwrap(), None);
    }
}
