//! The last time of a VCD, which may be later than its last change.

use std::fs::File;
use std::io::BufRead;
use std::path::Path;

use tofsim::error::{Error, Input, Result};

use super::bytes::Bytes;

/// Returns the last time of the VCD at `path`, in its ticks, if it has one.
///
/// # Errors
/// If the file cannot be read, or time goes back.
pub(super) fn end(path: &Path) -> Result<Option<u64>> {
    let file = File::open(path).map_err(Error::io(path, "read"))?;
    vcd(path, Bytes::new(file))
}

/// Returns the last time stamp of a VCD, and checks that time does not go back.
///
/// The library assumes that times are in order: otherwise it prints a line on standard output and omits changes.
fn vcd(path: &Path, mut file: impl BufRead) -> Result<Option<u64>> {
    let mut words = StampParser { line: 1, ..StampParser::default() };
    let fault = |(line, expected)| Input::new(path.display(), expected).at(line, 1);
    loop {
        let block = file.fill_buf().map_err(|error| Error::io(path, "read")(error))?;
        if block.is_empty() {
            // The last word may have no blank behind it.
            words.take(b"\n").map_err(fault)?;
            return Ok(words.last);
        }
        words.take(block).map_err(fault)?;
        let length = block.len();
        file.consume(length);
    }
}

/// Line number of an error in a VCD, and what was expected.
type Fault = (usize, String);

/// Parser of a VCD's words, which receives the text in blocks of any length.
#[derive(Debug, Default)]
struct StampParser {
    /// Line number, from 1.
    line: usize,
    word: Word,
    /// Whether the parser is within a command.
    in_command: bool,
    /// Whether the next word is a signal's name.
    is_name: bool,
    last: Option<u64>,
}

/// The word being parsed.
#[derive(Debug, Default, PartialEq, Eq)]
enum Word {
    /// No word.
    #[default]
    None,
    /// Neither time stamp nor command.
    Other,
    /// Text of a time stamp or a command, so far.
    StampOrCommand(Vec<u8>),
}

impl StampParser {
    fn take(&mut self, block: &[u8]) -> std::result::Result<(), Fault> {
        let mut rest = block;
        loop {
            if self.word == Word::None {
                let Some(begin) = rest.iter().position(|&byte| self.begins(byte)) else {
                    return Ok(());
                };
                rest = &rest[begin..];
                self.word = self.kind(rest[0]);
            }
            let end = rest.iter().position(u8::is_ascii_whitespace);
            let (word, behind) = rest.split_at(end.unwrap_or(rest.len()));
            if let Word::StampOrCommand(text) = &mut self.word {
                text.extend_from_slice(word);
            }
            if end.is_none() {
                return Ok(());
            }
            if let Word::StampOrCommand(text) = std::mem::take(&mut self.word) {
                self.parse_stamp_or_command(&text)?;
            }
            rest = behind;
        }
    }

    /// Returns whether a word begins with the byte, and counts lines.
    #[inline]
    fn begins(&mut self, byte: u8) -> bool {
        self.line += usize::from(byte == b'\n');
        !byte.is_ascii_whitespace()
    }

    /// Returns the kind of the word that begins with the byte.
    #[inline]
    fn kind(&mut self, first: u8) -> Word {
        let is_name = std::mem::take(&mut self.is_name);
        match first {
            _ if is_name => Word::Other,
            b'$' => Word::StampOrCommand(Vec::new()),
            _ if self.in_command => Word::Other,
            b'#' => Word::StampOrCommand(Vec::new()),
            _ => {
                self.is_name = matches!(first, b'b' | b'B' | b'r' | b'R' | b's' | b'S');
                Word::Other
            }
        }
    }

    fn parse_stamp_or_command(&mut self, word: &[u8]) -> std::result::Result<(), Fault> {
        match word {
            b"$end" => self.in_command = false,
            [b'$', ..] => self.in_command |= !word.starts_with(b"$dump"),
            _ => {
                let time =
                    stamp(&word[1..]).map_err(|expected| (self.line, expected.to_owned()))?;
                if let Some(last) = self.last.filter(|&last| time < last) {
                    return Err((self.line, format!("time goes back from {last} to {time}")));
                }
                self.last = Some(time);
            }
        }
        Ok(())
    }
}

/// Parses the time after a `#`.
///
/// # Errors
/// Description of what was expected.
fn stamp(digits: &[u8]) -> std::result::Result<u64, &'static str> {
    let text = std::str::from_utf8(digits).unwrap_or_default();
    if text.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        Err("expected a time behind #")
    } else {
        text.parse().map_err(|_| "expected a time below 2^64")
    }
}

#[cfg(test)]
mod tests {
    use std::io::BufReader;

    use super::*;

    fn last(text: &str) -> std::result::Result<Option<u64>, String> {
        let read = |block| {
            let file = BufReader::with_capacity(block, text.as_bytes());
            vcd(Path::new("a.vcd"), file).map_err(|error| error.to_string())
        };
        let whole = read(text.len());
        (1..20).for_each(|block| assert_eq!(read(block), whole, "{block} bytes at once"));
        whole
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
