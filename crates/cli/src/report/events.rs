//! A row for each shot, as CSV or Parquet.
//!
//! Columns: `frame`, `shot` (both from 0), `arrival_ps` (from the laser edge), `cause`, `n` (ones
//! count), `coarse`, `code`, `bin`; where frames come in pairs also `laser_en` (1 in lit frames). What
//! a shot does not have is empty (CSV) or null (Parquet). A photon that is given has no cause.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

use tofsim::error::{Error, Input, Result};
use tofsim::files::output::OutputFile;
use tofsim::sim::shot_recorder::Shot;

use super::causes;

const COLUMNS: [&str; 8] = ["frame", "shot", "arrival_ps", "cause", "n", "coarse", "code", "bin"];

/// The column of runs whose frames come in pairs.
const LASER: &str = "laser_en";

const SCHEMA: &str = "required int64 frame; required int64 shot; optional double arrival_ps;
    optional binary cause (UTF8); optional int32 n; optional int32 coarse;
    optional int32 code; optional int32 bin;";

/// Rows gathered before they go into a row group.
const GROUP: usize = 1 << 14;

/// The file under construction; nothing is left of it unless [`Events::finish`] is called.
pub enum Events {
    /// Comma-separated values.
    Csv(Box<Csv>),
    /// Apache Parquet.
    Parquet(Box<Parquet>),
}

/// A CSV file under construction.
pub struct Csv {
    writer: csv::Writer<OutputFile>,
    pairs: bool,
}

/// A Parquet file under construction.
pub struct Parquet {
    writer: SerializedFileWriter<OutputFile>,
    pairs: bool,
    rows: Vec<Shot>,
}

impl Events {
    /// Begins the file; its ending decides the format. With `pairs` it says of each shot whether the
    /// laser was on. `provenance` goes into Parquet's metadata.
    pub fn create(path: &Path, pairs: bool, provenance: &[String]) -> Result<Self> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        let device = std::fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
        if !device && ending != "csv" && ending != "parquet" {
            let expected = "expected a name that ends in .csv or .parquet";
            return Err(Input::new("--events", expected).value(path.display()).into());
        }
        let file = OutputFile::create(path)?;
        if ending != "parquet" {
            let mut writer = csv::Writer::from_writer(file);
            let columns = COLUMNS.into_iter().chain(pairs.then_some(LASER));
            writer.write_record(columns).map_err(|error| fault(path, error))?;
            return Ok(Events::Csv(Box::new(Csv { writer, pairs })));
        }
        let laser = if pairs { format!("required boolean {LASER};") } else { String::new() };
        let schema = parse_message_type(&format!("message shots {{ {SCHEMA} {laser} }}"));
        let schema = schema.map_err(|error| fault(path, error))?;
        let provenance = KeyValue::new("provenance".to_owned(), provenance.join("\n"));
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(vec![provenance]));
        let properties = Arc::new(properties.build());
        let writer = SerializedFileWriter::new(file, Arc::new(schema), properties);
        let writer = writer.map_err(|error| fault(path, error))?;
        Ok(Events::Parquet(Box::new(Parquet { writer, pairs, rows: Vec::with_capacity(GROUP) })))
    }

    /// Adds a row.
    pub fn write(&mut self, shot: &Shot) -> Result<()> {
        match self {
            Events::Csv(csv) => {
                let laser = csv.pairs.then(|| u8::from(shot.laser_en).to_string());
                let written = csv.writer.write_record(fields(shot).into_iter().chain(laser));
                written.map_err(|error| fault(csv.writer.get_ref().target(), error))
            }
            Events::Parquet(parquet) => {
                parquet.rows.push(*shot);
                if parquet.rows.len() == GROUP { parquet.flush() } else { Ok(()) }
            }
        }
    }

    /// Puts the file in place, and returns its path.
    pub fn finish(self) -> Result<PathBuf> {
        match self {
            Events::Csv(csv) => {
                let target = csv.writer.get_ref().target().to_owned();
                let file =
                    csv.writer.into_inner().map_err(|error| fault(&target, error.error()))?;
                file.commit().map(|()| target)
            }
            Events::Parquet(mut parquet) => {
                parquet.flush()?;
                let target = parquet.target();
                let file = parquet.writer.into_inner().map_err(|error| fault(&target, error))?;
                file.commit().map(|()| target)
            }
        }
    }
}

impl Parquet {
    fn target(&self) -> PathBuf {
        self.writer.inner().target().to_owned()
    }

    fn flush(&mut self) -> Result<()> {
        let target = self.target();
        self.write_group().map_err(|error| fault(&target, error))
    }

    fn write_group(&mut self) -> std::result::Result<(), ParquetError> {
        if self.rows.is_empty() {
            return Ok(());
        }
        let rows = std::mem::take(&mut self.rows);
        let mut group = self.writer.next_row_group()?;
        macro_rules! column {
            ($kind:ty, $of:expr, required) => {{
                let values: Vec<_> = rows.iter().map($of).collect();
                if let Some(mut column) = group.next_column()? {
                    column.typed::<$kind>().write_batch(&values, None, None)?;
                    column.close()?;
                }
            }};
            ($kind:ty, $of:expr) => {{
                let values: Vec<_> = rows.iter().filter_map($of).collect();
                let defined: Vec<_> = rows.iter().map(|row| $of(row).is_some() as i16).collect();
                if let Some(mut column) = group.next_column()? {
                    column.typed::<$kind>().write_batch(&values, Some(&defined), None)?;
                    column.close()?;
                }
            }};
        }
        column!(Int64Type, |row| row.frame as i64, required);
        column!(Int64Type, |row| row.shot as i64, required);
        column!(DoubleType, |row: &Shot| row.arrival_fs.map(|fs| fs as f64 / 1e3));
        column!(ByteArrayType, |row: &Shot| row
            .cause
            .map(|c| ByteArray::from(causes::name(Some(c)))));
        column!(Int32Type, |row: &Shot| row.n.map(|n| n as i32));
        column!(Int32Type, |row: &Shot| row.coarse.map(|coarse| coarse as i32));
        column!(Int32Type, |row: &Shot| row.code.map(|code| code as i32));
        column!(Int32Type, |row: &Shot| row.code.map(|bin| bin as i32));
        if self.pairs {
            column!(BoolType, |row| row.laser_en, required);
        }
        group.close()?;
        Ok(())
    }
}

fn fields(shot: &Shot) -> [String; 8] {
    let number = |value: Option<u64>| value.map_or(String::new(), |value| value.to_string());
    [
        shot.frame.to_string(),
        shot.shot.to_string(),
        shot.arrival_fs.map_or(String::new(), picoseconds),
        shot.cause.map_or("", |cause| causes::name(Some(cause))).to_owned(),
        number(shot.n),
        number(shot.coarse),
        number(shot.code),
        number(shot.code),
    ]
}

/// Femtoseconds as picoseconds with all three decimals.
fn picoseconds(fs: i64) -> String {
    format!("{}{}.{:03}", if fs < 0 { "-" } else { "" }, fs.abs() / 1000, fs.abs() % 1000)
}

fn fault(path: &Path, error: impl std::fmt::Display) -> Error {
    Error::Io {
        path: path.to_owned(),
        action: "write",
        source: std::io::Error::other(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn picoseconds_keep_every_femtosecond() {
        assert_eq!(picoseconds(3_335_641), "3335.641");
        assert_eq!(picoseconds(-1_002), "-1.002");
        assert_eq!(picoseconds(0), "0.000");
    }
}
