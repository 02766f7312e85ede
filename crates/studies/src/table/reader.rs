//! Reader of a sweep's Parquet table, row by row.

use std::collections::BTreeMap;
use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use parquet::basic::Type;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field as Value;
use parquet::record::reader::RowIter;

use tofsim::error::{Error, Input, Result};

use super::{Cell, Field, Kind, Row};

/// An open table.
pub struct TableReader {
    path: PathBuf,
    /// Metadata, by key.
    pub metadata: BTreeMap<String, String>,
    /// Columns.
    pub fields: Vec<Field>,
    /// Number of rows, as the file states it.
    pub count: u64,
    rows: RowIter<'static>,
}

impl TableReader {
    /// Opens a file.
    ///
    /// # Errors
    /// If it cannot be read, or is not the table of a sweep.
    pub fn open(path: &Path) -> Result<Self> {
        let file = File::open(path).map_err(Error::io(path, "read"))?;
        // Where the library panics over a damaged file, that is an error too.
        let opened = catch_unwind(AssertUnwindSafe(|| {
            let file = SerializedFileReader::new(file).map_err(|error| damaged(path, error))?;
            let about = file.metadata().file_metadata();
            let values = about.key_value_metadata().into_iter().flatten();
            let metadata =
                values.map(|pair| (pair.key.clone(), pair.value.clone().unwrap_or_default()));
            let metadata = metadata.collect();
            let columns = about.schema_descr().columns().iter().map(|column| {
                let kind = match column.physical_type() {
                    Type::INT64 => Kind::Whole,
                    Type::DOUBLE => Kind::Number,
                    Type::BYTE_ARRAY => Kind::Text,
                    _ => return Err(damaged(path, "a column of another type")),
                };
                Ok(Field::new(&column.path().string(), kind))
            });
            let fields = columns.collect::<Result<_>>()?;
            let count = about.num_rows().max(0) as u64;
            let rows = RowIter::from_file_into(Box::new(file));
            Ok(TableReader { path: path.to_owned(), metadata, fields, count, rows })
        }));
        opened.unwrap_or_else(|_| Err(damaged(path, "its pages are not as its header says")))
    }

    /// Reads the next row; returns `None` at the end.
    ///
    /// # Errors
    /// If the file is damaged.
    pub fn next_row(&mut self) -> Result<Option<Row>> {
        let rows = &mut self.rows;
        let next = catch_unwind(AssertUnwindSafe(|| rows.next()));
        let next = next.map_err(|_| damaged(&self.path, "its pages are not as its header says"))?;
        let Some(row) = next else { return Ok(None) };
        let row = row.map_err(|error| damaged(&self.path, error))?;
        let cell = |(_, value): (&String, &Value)| match value {
            Value::Null => Ok(Cell::None),
            Value::ULong(number) => Ok(Cell::Whole(*number)),
            Value::Double(number) => Ok(Cell::Number(*number)),
            Value::Str(text) => Ok(Cell::Text(text.clone())),
            _ => Err(damaged(&self.path, "a value of another type")),
        };
        let cells: Vec<_> = row.get_column_iter().map(cell).collect::<Result<_>>()?;
        match cells.first() {
            Some(Cell::Whole(point)) => Ok(Some(Row { point: *point, cells })),
            _ => Err(damaged(&self.path, "a row without its point")),
        }
    }
}

/// Creates the error for a damaged file.
pub fn damaged(path: &Path, error: impl std::fmt::Display) -> Error {
    Input::new(path.display(), format!("unreadable Parquet: {error}")).into()
}
