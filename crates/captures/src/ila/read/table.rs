//! The rows of a CSV as fields, each with its place for errors.

use std::fmt::Display;
use std::io::Read;

use ::csv::{ByteRecord, Error as CsvError, ErrorKind, Reader, ReaderBuilder};

use tofsim::error::{Error, Input, Result};

use super::lines::Lines;

/// Bytes read at a time.
const BLOCK: usize = 1 << 16;

/// A CSV, row by row.
pub(super) struct Table<R> {
    source: String,
    reader: Reader<Lines<R>>,
    record: ByteRecord,
    line: usize,
}

impl<R: Read> Table<R> {
    pub(super) fn new(source: &str, file: R) -> Self {
        let mut reader = ReaderBuilder::new();
        reader.has_headers(false).flexible(true).buffer_capacity(BLOCK);
        let reader = reader.from_reader(Lines::new(source.to_owned(), file));
        Table { source: source.to_owned(), reader, record: ByteRecord::new(), line: 0 }
    }

    /// Counts lines from `line` on.
    pub(super) fn starting_at(mut self, line: usize) -> Self {
        self.line = line - 1;
        self
    }

    /// Goes to the next row; false at the end.
    pub(super) fn advance(&mut self) -> Result<bool> {
        self.line += 1;
        self.reader.read_byte_record(&mut self.record).map_err(|error| self.broken(error))
    }

    /// Goes to the next row, which has to have `fields` fields; false at the end.
    pub(super) fn advance_to(&mut self, fields: usize) -> Result<bool> {
        let more = self.advance()?;
        if more && self.record.len() != fields {
            let found = self.record.len();
            let few = if found < fields { "few" } else { "many" };
            let text = format!("too {few} fields: {found}, expected {fields}");
            return Err(Input::new(&self.source, text).at(self.line, 1).into());
        }
        Ok(more)
    }

    /// A field of the row, empty if there is none.
    pub(super) fn field(&self, index: usize) -> &[u8] {
        self.record.get(index).unwrap_or_default()
    }

    /// Number of fields of the row.
    pub(super) fn len(&self) -> usize {
        self.record.len()
    }

    /// A field as a number, if it is one.
    pub(super) fn number(&self, index: usize) -> Option<u64> {
        let digits = self.field(index);
        let text = std::str::from_utf8(digits).ok().filter(|text| !text.starts_with('+'))?;
        text.parse().ok()
    }

    /// A field as text. `quoted` tells which fields stand in quotes.
    pub(super) fn text(&self, index: usize, quoted: impl Fn(usize) -> bool) -> Result<&str> {
        std::str::from_utf8(self.field(index))
            .map_err(|_| self.fault(index, "expected UTF-8 text", quoted).into())
    }

    /// A fault in a field of the row.
    pub(super) fn fault(
        &self,
        index: usize,
        expected: impl Display,
        quoted: impl Fn(usize) -> bool,
    ) -> Input {
        let start = self.record.range(index).map_or(0, |range| range.start);
        let before = String::from_utf8_lossy(&self.record.as_slice()[..start]);
        let mut column = before.chars().count() + index + 1;
        for field in (0..index).filter(|&field| quoted(field)) {
            column += 2 + self.field(field).iter().filter(|&&byte| byte == b'"').count();
        }
        let value = String::from_utf8_lossy(self.field(index));
        Input::new(&self.source, expected).at(self.line, column).value(value)
    }

    /// A fault of the whole row.
    pub(super) fn row_fault(&self, expected: impl Display) -> Input {
        Input::new(&self.source, expected).at(self.line, 1)
    }

    /// The file, read to some place.
    pub(super) fn into_inner(self) -> R {
        self.reader.into_inner().into_inner()
    }

    /// An error of reading; those of [`Lines`] are ours already.
    fn broken(&self, error: CsvError) -> Error {
        match error.into_kind() {
            ErrorKind::Io(error) => match error.downcast::<Error>() {
                Ok(error) => error,
                Err(source) => Error::Io { path: (&self.source).into(), action: "read", source },
            },
            kind => self.row_fault(format!("{kind:?}")).into(),
        }
    }
}
