//! A Parquet file under construction, group of rows by group of rows.

use std::fmt::Display;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::DataType;
use parquet::errors::Result as Written;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;

use tofsim::error::{Error, Result};
use tofsim::files::output::OutputFile;

/// Rows of a group.
pub const GROUP: usize = 1 << 14;

/// The file; nothing is left of it unless it is finished and put in place.
pub struct ParquetTable {
    writer: SerializedFileWriter<OutputFile>,
}

/// A group of rows, to be filled column by column.
pub struct RowGroup<'a>(SerializedRowGroupWriter<'a, OutputFile>);

impl ParquetTable {
    /// Begins the file with the columns of `schema`, and a key and its value in the metadata.
    pub fn create(file: OutputFile, schema: &str, key: &str, value: String) -> Result<Self> {
        let path = file.target().to_owned();
        let metadata = KeyValue::new(key.to_owned(), value);
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(vec![metadata]))
            .build();
        let schema = parse_message_type(schema).map_err(|error| fault(&path, error))?;
        let writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties));
        Ok(ParquetTable { writer: writer.map_err(|error| fault(&path, error))? })
    }

    /// Adds rows, whose columns `fill` writes in order.
    pub fn write_group(&mut self, fill: impl FnOnce(&mut RowGroup) -> Written<()>) -> Result<()> {
        let path = self.writer.inner().target().to_owned();
        let write = || {
            let mut group = RowGroup(self.writer.next_row_group()?);
            fill(&mut group)?;
            group.0.close().map(drop)
        };
        write().map_err(|error| fault(&path, error))
    }

    /// Completes the file, which is then to be put in place.
    pub fn finish(self) -> Result<OutputFile> {
        let path = self.writer.inner().target().to_owned();
        self.writer.into_inner().map_err(|error| fault(&path, error))
    }
}

impl RowGroup<'_> {
    /// The next column, where every row has a value.
    pub fn required<T: DataType>(&mut self, values: impl Iterator<Item = T::T>) -> Written<()> {
        self.column::<T>(&values.collect::<Vec<_>>(), None)
    }

    /// The next column, where a row may have none.
    pub fn optional<T: DataType>(
        &mut self,
        values: impl Iterator<Item = Option<T::T>>,
    ) -> Written<()> {
        let values: Vec<_> = values.collect();
        let defined: Vec<_> = values.iter().map(|value| i16::from(value.is_some())).collect();
        self.column::<T>(&values.into_iter().flatten().collect::<Vec<_>>(), Some(&defined))
    }

    fn column<T: DataType>(&mut self, values: &[T::T], defined: Option<&[i16]>) -> Written<()> {
        let Some(mut column) = self.0.next_column()? else { return Ok(()) };
        column.typed::<T>().write_batch(values, defined, None)?;
        column.close()
    }
}

fn fault(path: &Path, error: impl Display) -> Error {
    Error::io(path, "write")(std::io::Error::other(error.to_string()))
}
