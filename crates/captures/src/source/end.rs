//! How far a waveform goes, which its last change does not tell.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use memchr::memchr2;

use tofsim::error::{Error, Input, Result};

use super::signals::SourceFormat;

/// Bytes of a waveform that are read at once.
pub(super) const CHUNK: usize = 1 << 17;
/// Where an FST file's header has its end: after the block's type and length and the begin.
const FST_END: u64 = 1 + 8 + 8;

/// The last time of a waveform, in its ticks, if it says.
///
/// # Errors
/// When the file cannot be read, or time goes back in a VCD.
pub(super) fn end(path: &Path, format: SourceFormat) -> Result<Option<u64>> {
    let file = File::open(path).map_err(Error::io(path, "read"))?;
    match format {
        SourceFormat::Fst => fst(file).map_err(Error::io(path, "read")),
        SourceFormat::Vcd => vcd(path, BufReader::with_capacity(CHUNK, file)),
        _ => Ok(None),
    }
}

fn fst(mut file: File) -> std::io::Result<Option<u64>> {
    let mut end = [0; 8];
    file.seek(SeekFrom::Start(FST_END))?;
    Ok(file.read_exact(&mut end).is_ok().then_some(u64::from_be_bytes(end)))
}

/// The last time stamp of a VCD.
///
/// The library that reads the values takes the order of time for granted: where it goes back, it
/// prints a line on standard output and leaves changes out.
fn vcd(path: &Path, mut file: impl BufRead) -> Result<Option<u64>> {
    let (mut line, mut text) = (0, Vec::new());
    // Whether the words are those of a command, and the next is a signal's name.
    let (mut in_command, mut is_name) = (false, false);
    let mut last = None;
    while file.read_until(b'\n', &mut text).map_err(Error::io(path, "read"))? > 0 {
        line += 1;
        // Most lines change a value.
        let may_tell = in_command || is_name || memchr2(b'#', b'$', &text).is_some();
        let words = if may_tell { &text[..] } else { &[] };
        for word in words.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()) {
            match word[0] {
                _ if std::mem::take(&mut is_name) => {}
                b'$' if word == b"$end" => in_command = false,
                b'$' => in_command |= !word.starts_with(b"$dump"),
                _ if in_command => {}
                b'b' | b'B' | b'r' | b'R' | b's' | b'S' => is_name = true,
                b'#' => {
                    let fault = |expected| Input::new(path.display(), expected).at(line, 1);
                    let stamp = stamp(&word[1..]).map_err(|expected| fault(expected.to_owned()))?;
                    if let Some(last) = last.filter(|&last| stamp < last) {
                        return Err(fault(format!("time goes back from {last} to {stamp}")).into());
                    }
                    last = Some(stamp);
                }
                _ => {}
            }
        }
        text.clear();
    }
    Ok(last)
}

/// The time behind a `#`, or what was expected.
fn stamp(digits: &[u8]) -> std::result::Result<u64, &'static str> {
    let text = std::str::from_utf8(digits).unwrap_or_default();
    match text.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        true => Err("expected a time behind #"),
        false => text.parse().map_err(|_| "expected a time below 2^64"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn last(text: &str) -> std::result::Result<Option<u64>, String> {
        vcd(Path::new("a.vcd"), text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn the_last_time_stamp_of_a_vcd_is_its_end() {
        assert_eq!(last("$end\n#0\n1!\n#700\n0!\nb01 #\n#720\n"), Ok(Some(720)));
        let names =
            "$comment\n#5\n$end\n$var wire 1 # a $end\n#730 1!\nb0 $x\n#740 0!\nb0 #9\n0#\n";
        assert_eq!(last(names), Ok(Some(740)));
        assert_eq!(last("$end\n"), Ok(None));
    }

    #[test]
    fn time_may_stand_still_but_not_go_back() {
        assert_eq!(last("$end\n#0\n0#\n#5\nb01 #\n1!\n#5\n#70\n"), Ok(Some(70)));
        assert_eq!(last("#9\n$comment\n#0\n$end\n#9\n$comment #0 $end\n#10\n"), Ok(Some(10)));
        let back = last("$end\n#0\n0#\n#50\n1!\n#49\n1!\n");
        assert_eq!(back, Err("a.vcd:6:1: time goes back from 50 to 49".to_owned()));
    }

    #[test]
    fn a_time_beyond_64_bits_is_refused_with_its_line() {
        let error = last("#1\n#99999999999999999999\n");
        assert_eq!(error, Err("a.vcd:2:1: expected a time below 2^64".to_owned()));
    }
}
