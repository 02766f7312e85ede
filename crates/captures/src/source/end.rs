//! The last time of a VCD, which may be later than its last change, and the signals with words.

use std::collections::HashSet;
use std::fs::File;
use std::io::BufRead;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use tofsim::error::{Error, Input, Result, poll_stop};

use super::bytes::Bytes;

/// What the values of a VCD show.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Body {
    /// Last time, in ticks, if there is one.
    pub(super) end: Option<u64>,
    /// Codes of the signals with words.
    pub(super) texts: HashSet<Vec<u8>>,
}

/// Reads the values of the VCD at `path`, until `stop` is set.
///
/// # Errors
/// If the file cannot be read, time goes back, or it is stopped.
pub(super) fn body(path: &Path, stop: Option<&AtomicBool>) -> Result<Body> {
    let file = File::open(path).map_err(Error::io(path, "read"))?;
    vcd(path, Bytes::new(file), stop)
}

/// Scans a VCD, and checks that time does not go back.
///
/// The library assumes that times are in order: otherwise it prints a line on standard output and omits changes.
fn vcd(path: &Path, mut file: impl BufRead, stop: Option<&AtomicBool>) -> Result<Body> {
    let mut words = StampParser { line: 1, ..StampParser::default() };
    let fault = |(line, expected)| Input::new(path.display(), expected).at(line, 1);
    loop {
        poll_stop(stop)?;
        let block = file.fill_buf().map_err(|error| Error::io(path, "read")(error))?;
        if block.is_empty() {
            // The last word may have no blank behind it.
            words.take(b"\n").map_err(fault)?;
            return Ok(words.body);
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
    /// First byte of the value whose signal's code is the next word.
    value: Option<u8>,
    body: Body,
}

/// The word being parsed.
#[derive(Debug, Default, PartialEq, Eq)]
enum Word {
    /// No word.
    #[default]
    None,
    /// Neither time stamp nor command.
    Other,
    /// Code of a signal with words, so far.
    Code(Vec<u8>),
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
            if let Word::StampOrCommand(text) | Word::Code(text) = &mut self.word {
                text.extend_from_slice(word);
            }
            if end.is_none() {
                return Ok(());
            }
            match std::mem::take(&mut self.word) {
                Word::StampOrCommand(text) => self.parse_stamp_or_command(&text)?,
                Word::Code(code) if !self.body.texts.contains(&code) => {
                    self.body.texts.insert(code);
                }
                _ => {}
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
        match first {
            _ if self.value.is_some() => match self.value.take() {
                Some(b's' | b'S') => Word::Code(Vec::new()),
                _ => Word::Other,
            },
            b'$' => Word::StampOrCommand(Vec::new()),
            _ if self.in_command => Word::Other,
            b'#' => Word::StampOrCommand(Vec::new()),
            _ => {
                let has_code = matches!(first, b'b' | b'B' | b'r' | b'R' | b's' | b'S');
                self.value = has_code.then_some(first);
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
                if let Some(last) = self.body.end.filter(|&last| time < last) {
                    return Err((self.line, format!("time goes back from {last} to {time}")));
                }
                self.body.end = Some(time);
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

    /// Reads a text in blocks of that many bytes.
    fn read(text: &str, block: usize, is_stopped: bool) -> Result<Body> {
        let file = BufReader::with_capacity(block, text.as_bytes());
        vcd(Path::new("a.vcd"), file, Some(&AtomicBool::new(is_stopped)))
    }

    fn last(text: &str) -> std::result::Result<Option<u64>, String> {
        let read = |block| read(text, block, false).map_err(|error| error.to_string());
        let whole = read(text.len());
        (1..20).for_each(|block| assert_eq!(read(block), whole, "{block} bytes at once"));
        whole.map(|body| body.end)
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
    fn a_scan_can_be_stopped() {
        assert!(matches!(read("$end\n#0\n1!\n", 4, true), Err(Error::Interrupted)));
    }

    #[test]
    fn signals_with_words_are_found_by_their_codes() {
        let text = "$end\n#0\nsidle !\nb0 s\nr1.5 #\n$comment sx a $end\n1s\nSRUN \"\n";
        for block in 1..20 {
            let texts = read(text, block, false).unwrap().texts;
            assert_eq!(texts, HashSet::from([b"!".to_vec(), b"\"".to_vec()]));
        }
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
