//! Columns of numbers from a Parquet file, of any of its number types.

use std::fs::File;
use std::path::Path;

use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};

use tofsim::error::{Error, Input, Result};

use super::parquet_input::{damaged, guarded, open};

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
        let file = open(path)?;
        guarded(path, || read(&ParquetColumns { path, file }))
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
    /// When there is no such column, or more than one, it is none of numbers, or one is missing.
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>> {
        let names = self.names();
        let mut places = (0..names.len()).filter(|&place| names[place] == name);
        let place = match (places.next(), places.next()) {
            (Some(place), None) => place,
            (found, _) => {
                let expected =
                    if found.is_none() { "missing, expected numbers" } else { "there twice" };
                let fault = Input::new(self.path.display(), expected);
                return Err(fault.field(format!("column {name}")).into());
            }
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
