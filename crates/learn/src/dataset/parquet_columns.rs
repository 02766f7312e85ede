//! Columns of numbers from a Parquet file, of any of its number types.

use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};

use tofsim::error::{Error, Input, Result};

/// First bytes of a Parquet file.
pub const MAGIC: &[u8; 4] = b"PAR1";
/// Values read at a time.
const CHUNK: usize = 1 << 14;

/// A Parquet file, all of whose pages are read through here.
pub(super) struct ParquetColumns<'a> {
    path: &'a Path,
    file: SerializedFileReader<File>,
}

impl<'a> ParquetColumns<'a> {
    /// Opens a file and lets `read` look at its columns.
    ///
    /// # Errors
    /// When it is damaged, or `read` fails.
    pub fn with<T>(path: &'a Path, read: impl FnOnce(&Self) -> Result<T>) -> Result<T> {
        let file = File::open(path).map_err(Error::io(path, "read"))?;
        // Where the library panics over a damaged file after all, that is an error too.
        let read = catch_unwind(AssertUnwindSafe(|| {
            let file = SerializedFileReader::new(file).map_err(|error| damaged(path, error))?;
            read(&ParquetColumns { path, file })
        }));
        read.unwrap_or_else(|_| Err(damaged(path, "its pages are not as its header says")))
    }

    /// Names of the columns, in order.
    pub fn names(&self) -> Vec<String> {
        let schema = self.file.metadata().file_metadata().schema_descr();
        schema.columns().iter().map(|column| column.path().string()).collect()
    }

    /// Text of the metadata under a key.
    pub fn metadata(&self, key: &str) -> Option<&str> {
        let values = self.file.metadata().file_metadata().key_value_metadata()?;
        values.iter().find(|value| value.key == key)?.value.as_deref()
    }

    /// The numbers of a column, row by row.
    ///
    /// # Errors
    /// When there is no such column, it is none of numbers, or one is missing.
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>> {
        let Some(place) = self.names().iter().position(|known| known == name) else {
            let missing = Input::new(self.path.display(), "missing, expected numbers");
            return Err(missing.field(format!("column {name}")).into());
        };
        let column = self.file.metadata().file_metadata().schema_descr().column(place);
        if column.max_rep_level() > 0 || column.max_def_level() > 1 {
            return Err(self.no_numbers(name));
        }
        let mut numbers = Vec::new();
        for group in 0..self.file.num_row_groups() {
            let reader =
                self.file.get_row_group(group).map_err(|error| damaged(self.path, error))?;
            numbers.extend(self.values(&*reader, place, name, numbers.len())?);
        }
        Ok(numbers)
    }

    /// The numbers of a column in a group of rows.
    fn values(
        &self,
        group: &dyn RowGroupReader,
        place: usize,
        name: &str,
        first: usize,
    ) -> Result<Vec<f64>> {
        let stored = group.metadata().column(place);
        let dictionary = stored.dictionary_page_offset().unwrap_or(0);
        // The library panics over these.
        if stored.data_page_offset().min(dictionary).min(stored.compressed_size()) < 0 {
            return Err(damaged(self.path, "a column with a negative place or size"));
        }
        let column = group.get_column_reader(place);
        match column.map_err(|error| damaged(self.path, error))? {
            ColumnReader::Int32ColumnReader(reader) => self.all(reader, f64::from, name, first),
            ColumnReader::Int64ColumnReader(reader) => self.all(reader, |n| n as f64, name, first),
            ColumnReader::FloatColumnReader(reader) => self.all(reader, f64::from, name, first),
            ColumnReader::DoubleColumnReader(reader) => self.all(reader, f64::from, name, first),
            _ => Err(self.no_numbers(name)),
        }
    }

    fn all<T: DataType>(
        &self,
        mut reader: ColumnReaderImpl<T>,
        number: impl Fn(T::T) -> f64,
        name: &str,
        first: usize,
    ) -> Result<Vec<f64>> {
        let (mut values, mut defined) = (Vec::new(), Vec::new());
        loop {
            let read = reader.read_records(CHUNK, Some(&mut defined), None, &mut values);
            let (records, ..) = read.map_err(|error| damaged(self.path, error))?;
            if records == 0 {
                break;
            }
        }
        match defined.iter().position(|&level| level == 0) {
            None => Ok(values.into_iter().map(number).collect()),
            Some(row) => {
                let field = format!("row {}, column {name}", first + row);
                let missing = Input::new(self.path.display(), "expected a number");
                Err(missing.field(field).value("null").into())
            }
        }
    }

    fn no_numbers(&self, name: &str) -> Error {
        let expected = "expected a column of whole numbers or floats, one a row";
        Input::new(self.path.display(), expected).field(format!("column {name}")).into()
    }
}

fn damaged(path: &Path, error: impl std::fmt::Display) -> Error {
    Input::new(path.display(), format!("unreadable Parquet: {error}")).into()
}
