//! CSV files as input: a fixed header, `#` comments, faults with line and column.
//!
//! Fields are separated as in the header: by semicolons, tabs, commas or spaces. A decimal comma is read where commas do
//! not separate, as within quotes. Byte order marks, quotes and the line endings of any system are accepted.

use std::str::FromStr;

use crate::error::{Error, Input, Result};

/// Columns of a file, by name.
pub type Header = &'static [&'static str];

/// Rows of a CSV text below its header.
pub struct CsvInput<'a> {
    source: &'a str,
    header: Header,
    separator: char,
    lines: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
    row: Row<'a>,
    has_header: bool,
    /// Whether the first row, where a header might be, is a row of numbers that has yet to be read.
    is_pending: bool,
}

/// A line of the file that is neither empty nor a comment.
#[derive(Default)]
struct Row<'a> {
    /// Number of the line, from 1.
    line: usize,
    /// Column at which each field begins, from 1, and its text.
    fields: Vec<(usize, &'a str)>,
}

impl<'a> CsvInput<'a> {
    /// Creates a reader, and checks the header. Errors name the text as `source`.
    ///
    /// # Errors
    /// If the header differs from `header`.
    pub fn new(source: &'a str, text: &'a str, header: Header) -> Result<Self> {
        let input = Self::with_any(source, text, &[header])?;
        if input.has_header { Ok(input) } else { Err(input.other_header(&[header])) }
    }

    /// Creates a reader of a file with one of several headers, or with none: if the first row consists of numbers, the
    /// columns are those of the first header of their number.
    ///
    /// # Errors
    /// If the header is none of `headers`.
    pub fn with_any(source: &'a str, text: &'a str, headers: &[Header]) -> Result<Self> {
        let mut lines = filled_lines(text);
        let Some((line, first)) = lines.next() else {
            return Err(Input::new(source, format!("empty; {}", expected(headers))).into());
        };
        let separator = [';', '\t', ','].into_iter().find(|mark| first.contains(*mark));
        let separator = separator.unwrap_or(' ');
        let row = Row { line, fields: fields(first, separator) };
        let (header, lines) = (headers[0], Box::new(lines));
        let (has_header, is_pending) = (true, false);
        let mut input = CsvInput { source, header, separator, lines, row, has_header, is_pending };
        let names = || input.row.fields.iter().map(|(_, name)| *name);
        let count = input.row.fields.len();
        input.has_header = (0..count).any(|index| input.field::<f64>(index).is_none());
        input.is_pending = !input.has_header;
        let mut known = headers.iter();
        let found = if input.has_header {
            known.find(|header| names().eq(header.iter().copied()))
        } else {
            known.find(|header| header.len() == count)
        };
        input.header = found.ok_or_else(|| input.other_header(headers))?;
        Ok(input)
    }

    fn other_header(&self, headers: &[Header]) -> Error {
        let names: Vec<_> = self.row.fields.iter().map(|(_, name)| *name).collect();
        let mark = self.separator.to_string();
        let fault = Input::new(self.source, expected(headers)).value(names.join(&mark));
        fault.at(self.row.line, 1).into()
    }

    /// Returns the columns of the file.
    pub fn header(&self) -> Header {
        self.header
    }

    /// Returns whether the file has a header, and not only the columns of one.
    pub fn has_header(&self) -> bool {
        self.has_header
    }

    /// Advances to the next row, and returns false at the end.
    ///
    /// # Errors
    /// If the row has another number of fields than the header.
    pub fn advance(&mut self) -> Result<bool> {
        if !std::mem::take(&mut self.is_pending) {
            let Some((line, text)) = self.lines.next() else { return Ok(false) };
            self.row = Row { line, fields: fields(text, self.separator) };
        }
        let (found, expected) = (self.row.fields.len(), self.header.len());
        if found != expected {
            let fault = format!("the row has {found} fields, expected {expected}");
            return Err(Input::new(self.source, fault).at(self.row.line, 1).into());
        }
        Ok(true)
    }

    /// Parses a field of the row; returns `None` if it is invalid.
    pub fn field<T: FromStr>(&self, index: usize) -> Option<T> {
        let (_, text) = self.row.fields.get(index)?;
        let with_point = || text.replace(',', ".").parse().ok();
        text.parse().ok().or_else(with_point)
    }

    /// Parses a field of the row as a whole number, which may be written as a decimal one (`3.0`, `3e0`); returns `None` if
    /// it is invalid.
    pub fn whole(&self, index: usize) -> Option<u64> {
        let decimal =
            || self.field(index).filter(|x: &f64| x.fract() == 0.0 && (0.0..EXACT).contains(x));
        self.field(index).or_else(|| decimal().map(|x| x as u64))
    }

    /// Parses a field of the row as a number below `count`.
    ///
    /// # Errors
    /// If it is none.
    pub fn place(&self, index: usize, count: usize) -> Result<usize> {
        let found = self.field::<usize>(index).filter(|place| *place < count);
        Ok(found.ok_or_else(|| self.fault(index, format!("expected 0 to {}", count - 1)))?)
    }

    /// Creates an error at a field of the row.
    pub fn fault(&self, index: usize, expected: impl std::fmt::Display) -> Input {
        let (column, value) = self.row.fields.get(index).copied().unwrap_or((1, ""));
        let fault = Input::new(self.source, expected).at(self.row.line, column);
        fault.field(self.header.get(index).unwrap_or(&"row")).value(value)
    }
}

/// Number above which not every whole number is an `f64`.
const EXACT: f64 = (1u64 << f64::MANTISSA_DIGITS) as f64;

fn expected(headers: &[Header]) -> String {
    let names: Vec<_> = headers.iter().map(|header| format!("`{}`", header.join(","))).collect();
    let kind = if names.len() > 1 { "one of the headers" } else { "the header" };
    format!("expected {kind} {}", names.join(", "))
}

/// Returns the lines that are neither empty nor comments, with their numbers from 1.
fn filled_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let end = if text.contains('\n') { '\n' } else { '\r' };
    let lines = text.strip_prefix('\u{feff}').unwrap_or(text).split(end);
    let lines = lines.enumerate().map(|(index, line)| (index + 1, line.trim_end()));
    lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

/// Returns the fields of a line without the spaces and quotes around them, each with the column at which it begins, from 1.
/// Within quotes nothing separates.
fn fields(line: &str, separator: char) -> Vec<(usize, &str)> {
    let is_padding = |c: char| c.is_whitespace() || c == '"';
    let (mut fields, mut column, mut is_quoted) = (Vec::new(), 1, false);
    let separates = |c: char| {
        is_quoted ^= c == '"';
        c == separator && !is_quoted
    };
    for part in line.split(separates) {
        let padding = part.chars().take_while(|c| is_padding(*c)).count();
        fields.push((column + padding, part.trim_matches(is_padding)));
        column += part.chars().count() + 1;
    }
    fields.retain(|(_, field)| separator != ' ' || !field.is_empty());
    fields
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_blank_lines_are_passed_over() {
        let mut input =
            CsvInput::new("a.csv", "# seed 3\n\na,b\n1,2\n\n3,x\n", &["a", "b"]).unwrap();
        assert!(input.advance().unwrap());
        assert_eq!((input.field::<u8>(0), input.field::<f64>(1)), (Some(1), Some(2.0)));
        assert!(input.advance().unwrap());
        assert_eq!(input.field::<u8>(1), None);
        let fault = input.fault(1, "expected a number").to_string();
        assert_eq!(fault, "a.csv:6:3: b = x: expected a number");
        assert!(!input.advance().unwrap());
    }

    #[test]
    fn a_short_row_and_another_header_are_faults() {
        let mut input = CsvInput::new("a.csv", "a,b\n1\n", &["a", "b"]).unwrap();
        assert!(
            input.advance().unwrap_err().to_string().contains("a.csv:2:1: the row has 1 fields")
        );
        let error = |text| CsvInput::new("a.csv", text, &["a", "b"]).err().unwrap().to_string();
        assert!(error("b;a\n").contains("a.csv:1:1: b;a: expected the header `a,b`"));
        assert!(error("1,2\n").contains("a.csv:1:1: 1,2: expected the header `a,b`"));
        assert!(error("# none\n").contains("empty; expected the header"));
    }

    #[test]
    fn any_separator_and_line_ending_is_that_of_a_spreadsheet() {
        for text in [
            "a;b\n1,5;2\n",
            "a\tb\r\n1.5\t2\r\n",
            "\u{feff}\"a\", \"b\"\r\n1.5, \"2\"\r\n",
            "a b\n  1.5   2.0 \n",
            "a,b\r1.5,2e0\r",
            "a,b\n\"1,5\",\"2\"\n",
        ] {
            let mut input = CsvInput::new("a.csv", text, &["a", "b"]).unwrap();
            assert!(input.advance().unwrap(), "{text:?}");
            assert_eq!((input.field(0), input.whole(1)), (Some(1.5), Some(2)), "{text:?}");
            assert_eq!(input.whole(0), None);
            assert!(!input.advance().unwrap(), "{text:?}");
        }
    }

    #[test]
    fn a_file_without_a_header_has_that_of_its_number_of_columns() {
        let headers: [Header; 3] = [&["a", "b"], &["b"], &["c", "b"]];
        let header = |text| CsvInput::with_any("a.csv", text, &headers).map(|input| input.header());
        assert_eq!(header("0 1\n").unwrap(), headers[0]);
        assert_eq!(header("7\n").unwrap(), headers[1]);
        assert_eq!(header("c,b\n").unwrap(), headers[2]);
        let error = header("1,2,3\n").unwrap_err().to_string();
        assert!(error.ends_with("1,2,3: expected one of the headers `a,b`, `b`, `c,b`"), "{error}");
        let mut input = CsvInput::with_any("a.csv", "7\n8\n", &headers).unwrap();
        let mut rows = Vec::new();
        while input.advance().unwrap() {
            rows.push(input.whole(0).unwrap());
        }
        assert_eq!(rows, [7, 8]);
    }
}
