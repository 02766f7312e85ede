//! A dataset as Parquet: a column for each bin, as data frames have it.
//!
//! Columns: `row`, `seed`, `distance_m`, `reflectance`, `irradiance_w_m2_nm`, `b0` .. `b255`. What
//! the file is about stands in its metadata under [`KEY`], as JSON.

use std::path::Path;
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{DataType, DoubleType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;

use tofsim::error::{Error, Result};
use tofsim::files::output::OutputFile;
use tofsim::firmware::histogram_builder::BINS;

use super::blocks::Sample;

/// Key of the description in the file's metadata.
pub const KEY: &str = "tofsim.dataset";
/// Name of the file in a dataset's folder.
pub const NAME: &str = "dataset.parquet";
/// Columns before the bins.
pub(super) const HEAD: [&str; 5] =
    ["row", "seed", "distance_m", "reflectance", "irradiance_w_m2_nm"];

/// Rows gathered before they go into a row group.
const GROUP: usize = 1 << 14;

/// A Parquet file under construction; nothing is left of it unless it is finished and put in place.
pub struct ParquetFile {
    writer: SerializedFileWriter<OutputFile>,
    samples: Vec<Sample>,
}

impl ParquetFile {
    /// Begins the file; `description` goes into its metadata.
    pub fn create(path: &Path, description: &str) -> Result<Self> {
        let file = OutputFile::create(path)?;
        let description = KeyValue::new(KEY.to_owned(), description.to_owned());
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(vec![description]))
            .build();
        let schema = parse_message_type(&schema()).map_err(|error| fault(path, error))?;
        let writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties));
        let writer = writer.map_err(|error| fault(path, error))?;
        Ok(ParquetFile { writer, samples: Vec::with_capacity(GROUP) })
    }

    /// Adds rows.
    pub fn write(&mut self, mut samples: &[Sample]) -> Result<()> {
        while !samples.is_empty() {
            let (now, later) = samples.split_at(samples.len().min(GROUP - self.samples.len()));
            self.samples.extend_from_slice(now);
            samples = later;
            if self.samples.len() == GROUP {
                self.flush()?;
            }
        }
        Ok(())
    }

    /// Completes the file, which is then to be put in place.
    pub fn finish(mut self) -> Result<OutputFile> {
        self.flush()?;
        let target = self.writer.inner().target().to_owned();
        self.writer.into_inner().map_err(|error| fault(&target, error))
    }

    fn flush(&mut self) -> Result<()> {
        let target = self.writer.inner().target().to_owned();
        self.write_group().map_err(|error| fault(&target, error))?;
        self.samples.clear();
        Ok(())
    }

    fn write_group(&mut self) -> std::result::Result<(), ParquetError> {
        if self.samples.is_empty() {
            return Ok(());
        }
        let (samples, mut group) = (&self.samples, self.writer.next_row_group()?);
        let out = &mut group;
        column::<Int64Type>(out, samples, |sample| sample.row as i64)?;
        column::<Int64Type>(out, samples, |sample| sample.seed as i64)?;
        column::<DoubleType>(out, samples, |sample| sample.scene.distance_m)?;
        column::<DoubleType>(out, samples, |sample| sample.scene.reflectance)?;
        column::<DoubleType>(out, samples, |sample| sample.scene.irradiance_w_m2_nm)?;
        for bin in 0..BINS {
            column::<Int32Type>(out, samples, |sample| sample.histogram[bin].into())?;
        }
        group.close().map(drop)
    }
}

/// Writes the next column of a row group.
fn column<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, OutputFile>,
    samples: &[Sample],
    value: impl Fn(&Sample) -> T::T,
) -> std::result::Result<(), ParquetError> {
    let values: Vec<_> = samples.iter().map(value).collect();
    let Some(mut column) = group.next_column()? else { return Ok(()) };
    column.typed::<T>().write_batch(&values, None, None)?;
    column.close()
}

/// Name of a bin's column.
pub(super) fn bin_name(bin: usize) -> String {
    format!("b{bin}")
}

fn schema() -> String {
    let [row, seed, reals @ ..] = HEAD;
    let mut text = format!("message dataset {{ required int64 {row} (INTEGER(64,false)); ");
    text += &format!("required int64 {seed} (INTEGER(64,false)); ");
    text.extend(reals.map(|name| format!("required double {name}; ")));
    let bins = (0..BINS).map(bin_name);
    text.extend(bins.map(|name| format!("required int32 {name} (INTEGER(16,false)); ")));
    text + "}"
}

fn fault(path: &Path, error: ParquetError) -> Error {
    Error::io(path, "write")(std::io::Error::other(error.to_string()))
}
