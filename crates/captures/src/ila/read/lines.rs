//! Passes the bytes of a CSV on and checks its lines: one kind of line end, none without bound, none
//! empty but the last ones, no quotes across lines.

use std::io::{self, BufRead, BufReader, Read};

use tofsim::error::{Error, Input};

/// Longest line [bytes].
pub(super) const LONGEST_LINE: usize = 1 << 22;

/// A reader of lines that end alike.
pub(super) struct Lines<R> {
    source: String,
    inner: R,
    line: usize,
    /// Bytes of the line so far.
    length: usize,
    quotes: usize,
    last: u8,
    /// How the first line ends.
    returns: Option<bool>,
    /// The first of the empty lines just passed.
    empty: Option<usize>,
}

impl<R: Read> Lines<R> {
    pub(super) fn new(source: String, inner: R) -> Self {
        let (line, length, quotes, last) = (1, 0, 0, b'\n');
        Lines { source, inner, line, length, quotes, last, returns: None, empty: None }
    }

    pub(super) fn into_inner(self) -> R {
        self.inner
    }

    /// Looks at a byte; those above the quote need no look.
    fn look(&mut self, byte: u8) -> Result<(), Input> {
        let fault = |column, text: String| Input::new(&self.source, text).at(self.line, column);
        if self.last == b'\r' && byte != b'\n' {
            return Err(fault(
                self.length,
                "expected a line feed after the carriage return".into(),
            ));
        }
        match byte {
            b'\n' => {
                let returns = self.last == b'\r';
                if self.quotes % 2 == 1 {
                    return Err(fault(self.length, "a quote is not closed on its line".into()));
                }
                let first = *self.returns.get_or_insert(returns);
                if first != returns {
                    let name = |returns| if returns { "CRLF" } else { "LF" };
                    let (found, first) = (name(returns), name(first));
                    let text = format!("the line ends with {found}, those before it with {first}");
                    return Err(fault(self.length.max(1), text));
                }
                if self.length == returns as usize {
                    self.empty.get_or_insert(self.line);
                }
                (self.line, self.length, self.quotes) = (self.line + 1, 0, 0);
                return Ok(());
            }
            b'"' => self.quotes += 1,
            _ => {}
        }
        if byte != b'\r'
            && let Some(line) = self.empty
        {
            let text = "an empty line, and more lines after it";
            return Err(Input::new(&self.source, text).at(line, 1));
        }
        self.length += 1;
        if self.length > LONGEST_LINE {
            return Err(fault(1, format!("the line is longer than {LONGEST_LINE} bytes")));
        }
        Ok(())
    }
}

impl<R: Read> Read for Lines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        for &byte in &buffer[..count] {
            let plain = byte > b'"' && self.last != b'\r' && self.empty.is_none();
            if plain && self.length < LONGEST_LINE {
                self.length += 1;
            } else {
                self.look(byte).map_err(|fault| io::Error::other(Error::from(fault)))?;
            }
            self.last = byte;
        }
        if count == 0 && !buffer.is_empty() && self.quotes % 2 == 1 {
            let fault = Input::new(&self.source, "a quote is not closed at the end of the file");
            return Err(io::Error::other(Error::from(fault.at(self.line, self.length.max(1)))));
        }
        Ok(count)
    }
}

/// The first lines of a file, without their ends.
pub(super) fn first_lines<const N: usize>(file: impl Read) -> io::Result<[Vec<u8>; N]> {
    let mut reader = BufReader::new(file);
    let mut lines = [const { Vec::new() }; N];
    for line in &mut lines {
        reader.by_ref().take(LONGEST_LINE as u64 + 2).read_until(b'\n', line)?;
        line.pop_if(|&mut byte| byte == b'\n');
        line.pop_if(|&mut byte| byte == b'\r');
    }
    Ok(lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(text: &str) -> String {
        let mut read = String::new();
        let mut lines = Lines::new("a.csv".into(), text.as_bytes());
        lines
            .read_to_string(&mut read)
            .err()
            .map_or_else(|| "fine".into(), |error| error.to_string())
    }

    #[test]
    fn lines_that_end_alike_pass() {
        for text in ["", "a\nb", "a\nb\n", "a\r\nb\r\n", "a\n\"b,\"\"c\"\n", "a\n\n\n", "a\r\n\r\n"]
        {
            assert_eq!(fault(text), "fine", "{text:?}");
        }
    }

    #[test]
    fn the_first_line_that_ends_otherwise_is_named() {
        assert!(fault("a\nb\nc\r\n").starts_with("a.csv:3:2: the line ends with CRLF, those"));
        assert!(fault("a\r\nb\r\nc\n").starts_with("a.csv:3:1: the line ends with LF, those"));
        assert!(fault("a\nb\rc\n").starts_with("a.csv:2:2: expected a line feed after"));
    }

    #[test]
    fn quotes_empty_and_endless_lines_are_refused() {
        assert!(fault("a\n\"b\nc\"\n").starts_with("a.csv:2:2: a quote is not closed on its line"));
        assert!(fault("a\n\"b").starts_with("a.csv:2:2: a quote is not closed at the end"));
        assert!(fault("a\n\nb\n").starts_with("a.csv:2:1: an empty line, and more"));
        assert!(fault(&"a".repeat(LONGEST_LINE + 1)).contains("longer than 4194304 bytes"));
        assert_eq!(fault(&"a".repeat(LONGEST_LINE)), "fine");
    }
}
