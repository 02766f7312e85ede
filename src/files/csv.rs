//! CSV files as input: a fixed header, `#` comments, faults with line and column.

use std::str::FromStr;

use crate::error::{Input, Result};

/// Rows of a CSV text below its header.
pub struct CsvInput<'a> {
    source: &'a str,
    text: &'a str,
    header: &'a [&'a str],
    reader: csv::Reader<&'a [u8]>,
    record: csv::StringRecord,
}

impl<'a> CsvInput<'a> {
    /// Creates a reader, and checks the header. Errors name the text as `source`.
    ///
    /// # Errors
    /// If the header differs from `header`.
    pub fn new(source: &'a str, text: &'a str, header: &'a [&'a str]) -> Result<Self> {
        let mut reader = csv::ReaderBuilder::new();
        reader.has_headers(false).flexible(true).comment(Some(b'#'));
        let reader = reader.from_reader(text.as_bytes());
        let mut input = CsvInput { source, text, header, reader, record: csv::StringRecord::new() };
        let expected = || format!("expected the header `{}`", header.join(","));
        if !input.next_row()? {
            return Err(Input::new(source, format!("empty; {}", expected())).into());
        }
        if input.record.iter().map(str::trim).ne(header.iter().copied()) {
            let found: Vec<_> = input.record.iter().collect();
            let fault = Input::new(source, expected()).value(found.join(","));
            return Err(fault.at(input.line(), 1).into());
        }
        Ok(input)
    }

    /// Advances to the next row, and returns false at the end.
    ///
    /// # Errors
    /// If the row has another number of fields than the header.
    pub fn advance(&mut self) -> Result<bool> {
        let more = self.next_row()?;
        if more && self.record.len() != self.header.len() {
            let (found, expected) = (self.record.len(), self.header.len());
            let fault = format!("the row has {found} fields, expected {expected}");
            return Err(Input::new(self.source, fault).at(self.line(), 1).into());
        }
        Ok(more)
    }

    /// Parses a field of the row; returns `None` if it is invalid.
    pub fn field<T: FromStr>(&self, index: usize) -> Option<T> {
        self.record.get(index)?.trim().parse().ok()
    }

    /// Creates an error at a field of the row.
    pub fn fault(&self, index: usize, expected: impl std::fmt::Display) -> Input {
        let value = self.record.get(index).unwrap_or_default();
        let start = self.record.range(index).map_or(0, |range| range.start + index);
        let fault = Input::new(self.source, expected).at(self.line(), start + 1);
        fault.field(self.header.get(index).unwrap_or(&"row")).value(value)
    }

    fn next_row(&mut self) -> Result<bool> {
        let more = self.reader.read_record(&mut self.record);
        Ok(more.map_err(|error| Input::new(self.source, error))?)
    }

    /// Returns the line number of the row, past any comments before it.
    fn line(&self) -> usize {
        let Some(position) = self.record.position() else { return 1 };
        let rest = self.text.get(position.byte() as usize..).unwrap_or_default();
        let passed = rest.lines().take_while(|line| line.is_empty() || line.starts_with('#'));
        position.line() as usize + passed.count()
    }
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
        assert!(error("a;b\n").contains("a;b: expected the header `a,b`"));
        assert!(error("# none\n").contains("empty; expected the header"));
    }
}
