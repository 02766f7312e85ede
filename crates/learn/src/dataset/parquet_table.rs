//! A Parquet file under construction, group of rows by group of rows.

use std::collections::VecDeque;
use std::fmt::Display;
use std::path::Path;
use std::sync::Arc;

use bytes::Bytes;
use parquet::basic::Compression;
use parquet::column::writer::{get_column_writer, get_typed_column_writer};
use parquet::data_type::DataType;
use parquet::errors::Result as Written;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{WriterProperties, WriterPropertiesPtr};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use parquet::schema::types::ColumnDescPtr;

use tofsim::error::{Error, Result};
use tofsim::files::output::OutputFile;

use super::parquet_checksum::Checksummed;
use super::parquet_pages::ChecksummedPages;

/// Rows of a group.
const GROUP: usize = 1 << 14;

/// Writes the columns of rows, in order.
type Fill<R> = dyn Fn(&mut RowGroup, &[R]) -> Written<()> + Send;

/// The file; nothing is left of it unless it is finished and put in place.
pub struct ParquetTable<R> {
    writer: SerializedFileWriter<Checksummed>,
    fill: Box<Fill<R>>,
    /// Rows gathered for the next group.
    rows: Vec<R>,
}

/// A group of rows, to be filled column by column.
pub struct RowGroup<'a> {
    writer: SerializedRowGroupWriter<'a, Checksummed>,
    properties: WriterPropertiesPtr,
    /// Columns that are still to be filled.
    columns: VecDeque<ColumnDescPtr>,
}

impl<R: Clone> ParquetTable<R> {
    /// Begins the file with the columns of `schema`, keys and their values in the metadata, and what
    /// writes the columns of some rows in order.
    pub fn create(
        file: OutputFile,
        schema: &str,
        metadata: impl IntoIterator<Item = (&'static str, String)>,
        fill: impl Fn(&mut RowGroup, &[R]) -> Written<()> + Send + 'static,
    ) -> Result<Self> {
        let path = file.target().to_owned();
        let metadata =
            metadata.into_iter().map(|(key, value)| KeyValue::new(key.to_owned(), value));
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(metadata.collect()))
            .build();
        let schema = parse_message_type(schema).map_err(|error| fault(&path, error))?;
        let file = Checksummed::new(file);
        let writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties));
        let writer = writer.map_err(|error| fault(&path, error))?;
        Ok(ParquetTable { writer, fill: Box::new(fill), rows: Vec::with_capacity(GROUP) })
    }

    /// Adds rows.
    pub fn write(&mut self, rows: &[R]) -> Result<()> {
        for row in rows {
            self.rows.push(row.clone());
            if self.rows.len() == GROUP {
                self.write_group()?;
            }
        }
        Ok(())
    }

    fn write_group(&mut self) -> Result<()> {
        let path = self.writer.inner().file().target().to_owned();
        let mut write = || {
            let properties = self.writer.properties().clone();
            let columns = self.writer.schema_descr().columns().iter().cloned().collect();
            let mut group = RowGroup { writer: self.writer.next_row_group()?, properties, columns };
            (self.fill)(&mut group, &self.rows)?;
            group.writer.close().map(drop)
        };
        write().map_err(|error| fault(&path, error))?;
        self.rows.clear();
        Ok(())
    }

    /// Completes the file, which is then to be put in place.
    pub fn finish(mut self) -> Result<OutputFile> {
        if !self.rows.is_empty() {
            self.write_group()?;
        }
        let path = self.writer.inner().file().target().to_owned();
        let checksum = self.writer.inner_mut().begin_footer();
        self.writer.append_key_value_metadata(checksum);
        let file = self.writer.into_inner().map_err(|error| fault(&path, error))?;
        file.finish().map_err(|error| fault(&path, error))
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
        let Some(column) = self.columns.pop_front() else { return Ok(()) };
        let mut bytes = Vec::new();
        let pages = Box::new(ChecksummedPages::new(&mut bytes));
        let writer = get_column_writer(column, self.properties.clone(), pages);
        let mut writer = get_typed_column_writer::<T>(writer);
        writer.write_batch(values, defined, None)?;
        let closed = writer.close()?;
        self.writer.append_column(&Bytes::from(bytes), closed)
    }
}

fn fault(path: &Path, error: impl Display) -> Error {
    Error::io(path, "write")(std::io::Error::other(error.to_string()))
}
