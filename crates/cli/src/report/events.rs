//! A row for each shot, as CSV or Parquet.
//!
//! Columns: `frame`, `shot` (both from 0), `arrival_ps` (from the laser edge), `cause`, `n` (ones
//! count), `coarse`, `code`, `bin`; where frames come in pairs also `laser_en` (1 in lit frames). What
//! a shot does not have is empty (CSV) or null (Parquet). A photon that is given has no cause.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int32Type, Int64Type};

use tofsim::error::{Error, Input, Result};
use tofsim::files::output::OutputFile;
use tofsim::sim::shot_recorder::Shot;
use tofsim_learn::dataset::parquet_table::{ParquetTable, RowGroup};

use super::causes;

const COLUMNS: &str = "frame,shot,arrival_ps,cause,n,coarse,code,bin";

/// The column of runs whose frames come in pairs.
const LASER: &str = "laser_en";

const SCHEMA: &str = "required int64 frame; required int64 shot; optional double arrival_ps;
    optional binary cause (UTF8); optional int32 n; optional int32 coarse;
    optional int32 code; optional int32 bin;";

/// The file under construction; nothing is left of it unless [`Events::finish`] is called.
pub struct Events {
    file: EventFile,
    /// Whether frames come in pairs.
    pairs: bool,
}

enum EventFile {
    Csv(OutputFile),
    Parquet(Box<ParquetTable<Shot>>),
}

impl Events {
    /// Begins the file; its ending decides the format. With `pairs` it says of each shot whether the
    /// laser was on. `record` goes into the first line of a CSV
    /// and into Parquet's metadata.
    pub fn create(path: &Path, pairs: bool, record: &str) -> Result<Self> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        let device = std::fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
        if !device && ending != "csv" && ending != "parquet" {
            let expected = "expected a name that ends in .csv or .parquet";
            return Err(Input::new("--events", expected).value(path.display()).into());
        }
        let mut file = OutputFile::create(path)?;
        let file = if ending == "parquet" {
            let laser = if pairs { format!("required boolean {LASER};") } else { String::new() };
            let schema = format!("message shots {{ {SCHEMA} {laser} }}");
            let provenance = ("provenance", record.to_owned());
            let fill = move |group: &mut RowGroup, shots: &[Shot]| columns(group, shots, pairs);
            EventFile::Parquet(Box::new(ParquetTable::create(file, &schema, [provenance], fill)?))
        } else {
            let laser = if pairs { format!(",{LASER}") } else { String::new() };
            writeln!(file, "# {record}\n{COLUMNS}{laser}").map_err(|error| fault(path, error))?;
            EventFile::Csv(file)
        };
        Ok(Events { file, pairs })
    }

    /// Adds a row.
    pub fn write(&mut self, shot: &Shot) -> Result<()> {
        match &mut self.file {
            EventFile::Csv(file) => {
                let laser = match (self.pairs, shot.laser_en) {
                    (false, _) => "",
                    (true, false) => ",0",
                    (true, true) => ",1",
                };
                let written = writeln!(file, "{}{laser}", fields(shot).join(","));
                written.map_err(|error| fault(file.target(), error))
            }
            EventFile::Parquet(table) => table.write(&[*shot]),
        }
    }

    /// Puts the file in place, and returns its path.
    pub fn finish(self) -> Result<PathBuf> {
        let file = match self.file {
            EventFile::Csv(file) => file,
            EventFile::Parquet(table) => table.finish()?,
        };
        let target = file.target().to_owned();
        file.commit().map(|()| target)
    }
}

/// Writes the columns of shots.
fn columns(group: &mut RowGroup, shots: &[Shot], pairs: bool) -> parquet::errors::Result<()> {
    let cause = |shot: &Shot| shot.cause.map(|cause| ByteArray::from(causes::name(Some(cause))));
    let whole = |value: u64| value as i32;
    let shots = || shots.iter();
    group.required::<Int64Type>(shots().map(|shot| shot.frame as i64))?;
    group.required::<Int64Type>(shots().map(|shot| shot.shot as i64))?;
    let arrivals_ps = shots().map(|shot| shot.arrival_fs.map(|fs| fs as f64 / 1e3));
    group.optional::<DoubleType>(arrivals_ps)?;
    group.optional::<ByteArrayType>(shots().map(cause))?;
    group.optional::<Int32Type>(shots().map(|shot| shot.n.map(whole)))?;
    group.optional::<Int32Type>(shots().map(|shot| shot.coarse.map(whole)))?;
    group.optional::<Int32Type>(shots().map(|shot| shot.code.map(whole)))?;
    group.optional::<Int32Type>(shots().map(|shot| shot.code.map(whole)))?;
    if pairs { group.required::<BoolType>(shots().map(|shot| shot.laser_en)) } else { Ok(()) }
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

fn fault(path: &Path, error: io::Error) -> Error {
    Error::io(path, "write")(io::Error::other(error.to_string()))
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
