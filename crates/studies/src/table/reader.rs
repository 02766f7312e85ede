//! Reader of a sweep's Parquet table, row by row.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use parquet::basic::Type;
use parquet::file::reader::FileReader;
use parquet::record::Field as Value;
use parquet::record::reader::RowIter;

use tofsim::error::Result;
use tofsim_learn::dataset::parquet_input::{damaged, guarded, open};

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
        let file = open(path)?;
        guarded(path, || {
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
        })
    }

    /// Reads the next row; returns `None` at the end.
    ///
    /// # Errors
    /// If the file is damaged.
    pub fn next_row(&mut self) -> Result<Option<Row>> {
        let rows = &mut self.rows;
        let Some(row) = guarded(&self.path, || Ok(rows.next()))? else { return Ok(None) };
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
