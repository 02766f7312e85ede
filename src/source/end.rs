//! How far a waveform goes, which its last change does not tell.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use crate::error::{Error, Result};

use super::Format;

/// Bytes at the end of a VCD in which its last time stamp is looked for.
const TAIL: u64 = 1 << 16;
/// Where an FST file's header has its end: after the block's type and length and the begin.
const FST_END: u64 = 1 + 8 + 8;

/// The last time of a waveform, in its ticks, if it says.
///
/// # Errors
/// When the file cannot be read.
pub(super) fn end(path: &Path, format: Format) -> Result<Option<u64>> {
    let mut file = File::open(path).map_err(Error::io(path, "read"))?;
    let found = match format {
        Format::Fst => fst(&mut file),
        Format::Vcd => vcd(&mut file),
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
    let lines = tail.split(|&byte| byte == b'\n');
    let stamps = lines.filter_map(|line| line.trim_ascii().strip_prefix(b"#"));
    let times = stamps.filter_map(|digits| std::str::from_utf8(digits).ok()?.parse().ok());
    // The last one may be cut off; reading it will tell.
    Ok(times.max())
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn the_last_time_stamp_of_a_vcd_is_its_end() {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        write!(file, "$end\n#0\n1!\n#700\n0!\nb01 #\n#720\n").unwrap();
        assert_eq!(end(file.path(), Format::Vcd).unwrap(), Some(720));
        write!(file, "{}", "1!\n".repeat(40_000)).unwrap();
        assert_eq!(end(file.path(), Format::Vcd).unwrap(), None);
    }
}
