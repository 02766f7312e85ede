//! Lines of a CSV as fields, with their positions for errors.
//!
//! All lines have the same ending and a limited length, quotes end on the same line, and only the last lines may be
//! empty. Empty fields at the end of a line, which spreadsheets add, are removed.

use std::borrow::Cow;
use std::fmt::Display;
use std::io::{self, BufRead, BufReader, Read};
use std::ops::Range;
use std::path::Path;

use tofsim::error::{Error, Input, Result};

/// Longest line [bytes].
const LONGEST: usize = 1 << 22;

/// Reader of a CSV, line by line.
pub(super) struct Table<R> {
    file: BufReader<R>,
    /// Present line.
    pub(super) row: Row,
    /// Whether lines end with a carriage return, once known.
    returns: Option<bool>,
    /// Whether a line had additional empty fields.
    pub(super) trails: bool,
}

/// A line without its ending, and its fields.
#[derive(Default)]
pub(super) struct Row {
    source: String,
    line: usize,
    text: Vec<u8>,
    /// Field separator.
    delimiter: u8,
    fields: Vec<Range<usize>>,
}

impl<R: Read> Table<R> {
    pub(super) fn new(source: &str, file: R, delimiter: u8) -> Self {
        let row = Row { source: source.to_owned(), delimiter, ..Row::default() };
        let file = BufReader::with_capacity(1 << 16, file);
        Table { file, row, returns: None, trails: false }
    }

    /// Advances to the next row; returns false at the end.
    pub(super) fn advance(&mut self) -> Result<bool> {
        let mut empty = None;
        while self.next_line()? {
            match (self.row.text.is_empty(), empty) {
                (true, _) => empty = empty.or(Some(self.row.line)),
                (false, Some(line)) => {
                    let expected = "an empty line, and more lines after it";
                    return Err(Input::new(&self.row.source, expected).at(line, 1).into());
                }
                (false, None) => {
                    self.row.split();
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Advances to the next row, which must have `fields` fields; returns false at the end.
    pub(super) fn advance_to(&mut self, fields: usize) -> Result<bool> {
        let more = self.advance()?;
        let found = self.row.len();
        if more && found != fields {
            if found > fields && (fields..found).all(|index| self.row.field(index).is_empty()) {
                self.trails = true;
                return Ok(true);
            }
            let few = if found < fields { "few" } else { "many" };
            let text = format!("too {few} fields: {found}, expected {fields}");
            return Err(self.row.row_fault(text).into());
        }
        Ok(more)
    }

    /// Reads a line; returns false at the end.
    fn next_line(&mut self) -> Result<bool> {
        let Row { source, line, text, .. } = &mut self.row;
        text.clear();
        *line += 1;
        let mut limited = self.file.by_ref().take(LONGEST as u64 + 2);
        limited.read_until(b'\n', text).map_err(Error::io(Path::new(source), "read"))?;
        if text.is_empty() {
            return Ok(false);
        }
        let ended = text.pop_if(|&mut byte| byte == b'\n').is_some();
        let length = text.len();
        let returns = text.pop_if(|&mut byte| byte == b'\r').is_some();
        let fault = |column: usize, expected: String| {
            Err(Input::new(&source, expected).at(*line, column.max(1)).into())
        };
        if text.len() > LONGEST {
            return fault(1, format!("the line is longer than {LONGEST} bytes"));
        }
        if let Some(place) = text.iter().position(|&byte| byte == b'\r') {
            return fault(place + 1, "expected a line feed after the carriage return".into());
        }
        if text.iter().filter(|&&byte| byte == b'"').count() % 2 == 1 {
            let place = if ended { "on its line" } else { "at the end of the file" };
            return fault(length, format!("a quote is not closed {place}"));
        }
        if ended && *self.returns.get_or_insert(returns) != returns {
            let [found, first] = if returns { ["CRLF", "LF"] } else { ["LF", "CRLF"] };
            let text = format!("the line ends with {found}, those before it with {first}");
            return fault(length, text);
        }
        Ok(true)
    }

    /// Unwraps the file, at an unspecified position.
    pub(super) fn into_inner(self) -> R {
        self.file.into_inner()
    }
}

impl Row {
    /// Splits a line with the given number.
    pub(super) fn new(source: &str, line: usize, text: &[u8], delimiter: u8) -> Self {
        let (source, text) = (source.to_owned(), text.to_owned());
        let mut row = Row { source, line, text, delimiter, fields: Vec::new() };
        row.split();
        row
    }

    /// Removes empty fields at the end; returns whether there were any.
    pub(super) fn take_trail(&mut self) -> bool {
        let end = (0..self.len()).rposition(|index| !self.field(index).is_empty());
        let before = self.len();
        self.fields.truncate(end.map_or(1, |last| last + 1));
        self.len() < before
    }

    fn split(&mut self) {
        let (mut begin, mut inside) = (0, false);
        self.fields.clear();
        for (place, &byte) in self.text.iter().enumerate() {
            inside ^= byte == b'"';
            if byte == self.delimiter && !inside {
                self.fields.push(begin..place);
                begin = place + 1;
            }
        }
        self.fields.push(begin..self.text.len());
    }

    /// Returns the number of fields.
    pub(super) fn len(&self) -> usize {
        self.fields.len()
    }

    fn spelled(&self, index: usize) -> &[u8] {
        self.fields.get(index).map_or(&[], |range| &self.text[range.clone()])
    }

    /// Returns whether a field is quoted.
    pub(super) fn is_quoted(&self, index: usize) -> bool {
        self.spelled(index).starts_with(b"\"")
    }

    /// Returns a field without its quotes; empty if there is none.
    pub(super) fn field(&self, index: usize) -> Cow<'_, [u8]> {
        let spelled = self.spelled(index);
        let Some(inside) = spelled.strip_prefix(b"\"") else { return spelled.into() };
        let inside = inside.strip_suffix(b"\"").unwrap_or(inside);
        // Of two quotes the second stands for itself.
        let mut is_first = false;
        let stands = |byte: &&u8| {
            is_first = **byte == b'"' && !is_first;
            !is_first
        };
        inside.iter().filter(stands).copied().collect()
    }

    /// Returns whether a field equals a text.
    pub(super) fn is(&self, index: usize, text: &str) -> bool {
        *self.field(index) == *text.as_bytes()
    }

    /// Parses a field as a number.
    pub(super) fn number(&self, index: usize) -> Option<u64> {
        let digits = self.field(index);
        let text = std::str::from_utf8(&digits).ok().filter(|text| !text.starts_with('+'))?;
        text.parse().ok()
    }

    /// Returns a field as text.
    pub(super) fn text(&self, index: usize) -> Result<String> {
        String::from_utf8(self.field(index).into_owned())
            .map_err(|_| self.fault(index, "expected UTF-8 text").into())
    }

    /// Creates an error at a field.
    pub(super) fn fault(&self, index: usize, expected: impl Display) -> Input {
        let begin = self.fields.get(index).map_or(0, |range| range.start);
        let column = String::from_utf8_lossy(&self.text[..begin]).chars().count() + 1;
        let value = self.field(index);
        let value = String::from_utf8_lossy(&value);
        Input::new(&self.source, expected).at(self.line, column).value(value)
    }

    /// Creates an error for the whole row.
    pub(super) fn row_fault(&self, expected: impl Display) -> Input {
        let line = String::from_utf8_lossy(&self.text);
        Input::new(&self.source, expected).at(self.line, 1).value(line)
    }
}

/// Reads the first lines of a file, without their endings.
pub(super) fn first_lines<const N: usize>(file: impl Read) -> io::Result<[Vec<u8>; N]> {
    let mut reader = BufReader::new(file);
    let mut lines = [const { Vec::new() }; N];
    for line in &mut lines {
        reader.by_ref().take(LONGEST as u64 + 2).read_until(b'\n', line)?;
        line.pop_if(|&mut byte| byte == b'\n');
        line.pop_if(|&mut byte| byte == b'\r');
    }
    Ok(lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(text: &str) -> String {
        let mut table = Table::new("a.csv", text.as_bytes(), b',');
        loop {
            match table.advance() {
                Ok(true) => {}
                Ok(false) => return "fine".to_owned(),
                Err(error) => return error.to_string(),
            }
        }
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
        assert!(fault(&"a".repeat(LONGEST + 1)).contains("longer than 4194304 bytes"));
        assert_eq!(fault(&"a".repeat(LONGEST)), "fine");
    }

    #[test]
    fn fields_in_quotes_are_found() {
        let row = Row::new("a.csv", 1, b"0,0,1,\"a,\"\"b\"\"\",ff,\"\",\"x\"", b',');
        let found: Vec<_> = (0..row.len()).map(|index| row.is_quoted(index)).collect();
        assert_eq!(found, [false, false, false, true, false, true, true]);
        let fields = [3, 5, 6].map(|index| row.text(index).unwrap());
        assert_eq!(fields, ["a,\"b\"", "", "x"]);
    }
}
