//! A row for each shot, as CSV or Parquet.
//!
//! Columns: `frame`, `shot` (both from 0), `arrival_ps` (from the laser edge), `cause`, `n` (ones
//! count), `coarse`, `code`, `bin`; where frames come in pairs also `laser_en` (1 in lit frames). What
//! a shot does not have is empty (CSV) or null (Parquet). A photon that is given has no cause.

use std::path::{Path, PathBuf};

use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int32Type, Int64Type};
use parquet::errors::Result as Written;

use tofsim::error::{Input, Result};
use tofsim::files::output::OutputFile;
use tofsim::sim::shot_recorder::Shot;
use tofsim_learn::dataset::parquet_table::{ParquetTable, RowGroup};
use tofsim_studies::table::csv_file::CsvFile;

use super::causes;

/// The columns, by name; the last one only where frames come in pairs.
const COLUMNS: [(&str, Values); 9] = [
    ("frame", Values::Number(|shot| shot.frame)),
    ("shot", Values::Number(|shot| shot.shot)),
    ("arrival_ps", Values::Time(|shot| shot.arrival_fs)),
    ("cause", Values::Word(|shot| shot.cause.map(|cause| causes::name(Some(cause))))),
    ("n", Values::Count(|shot| shot.n)),
    ("coarse", Values::Count(|shot| shot.coarse)),
    ("code", Values::Count(|shot| shot.code)),
    ("bin", Values::Count(|shot| shot.code)),
    ("laser_en", Values::Flag(|shot| shot.laser_en)),
];

/// The values of a column.
#[derive(Clone, Copy)]
enum Values {
    /// A number that every shot has.
    Number(fn(&Shot) -> u64),
    /// A time, if there is one [fs].
    Time(fn(&Shot) -> Option<i64>),
    /// A word, if there is one.
    Word(fn(&Shot) -> Option<&'static str>),
    /// A number, if there is one.
    Count(fn(&Shot) -> Option<u64>),
    /// A level that every shot has.
    Flag(fn(&Shot) -> bool),
}

impl Values {
    /// Declares the column in a Parquet schema.
    fn declaration(self, name: &str) -> String {
        match self {
            Values::Number(_) => format!("required int64 {name}; "),
            Values::Time(_) => format!("optional double {name}; "),
            Values::Word(_) => format!("optional binary {name} (UTF8); "),
            Values::Count(_) => format!("optional int32 {name}; "),
            Values::Flag(_) => format!("required boolean {name}; "),
        }
    }

    /// Writes the column of some shots.
    fn fill(self, group: &mut RowGroup, shots: &[Shot]) -> Written<()> {
        let shots = shots.iter();
        match self {
            Values::Number(of) => group.required::<Int64Type>(shots.map(|shot| of(shot) as i64)),
            Values::Time(of) => {
                group.optional::<DoubleType>(shots.map(|shot| of(shot).map(|fs| fs as f64 / 1e3)))
            }
            Values::Word(of) => {
                group.optional::<ByteArrayType>(shots.map(|shot| of(shot).map(ByteArray::from)))
            }
            Values::Count(of) => {
                group.optional::<Int32Type>(shots.map(|shot| of(shot).map(|number| number as i32)))
            }
            Values::Flag(of) => group.required::<BoolType>(shots.map(of)),
        }
    }

    /// Returns the value of a shot, as CSV has it.
    fn text(self, shot: &Shot) -> String {
        match self {
            Values::Number(of) => of(shot).to_string(),
            Values::Time(of) => of(shot).map_or(String::new(), picoseconds),
            Values::Word(of) => of(shot).unwrap_or_default().to_owned(),
            Values::Count(of) => of(shot).map_or(String::new(), |number| number.to_string()),
            Values::Flag(of) => u8::from(of(shot)).to_string(),
        }
    }
}

/// The file under construction; nothing is left of it unless [`Events::finish`] is called.
pub struct Events {
    path: PathBuf,
    file: EventFile,
    columns: &'static [(&'static str, Values)],
}

enum EventFile {
    Csv(Box<CsvFile>),
    Parquet(Box<ParquetTable<Shot>>),
}

impl Events {
    /// Begins the file; its ending decides the format. With `pairs` it says of each shot whether the
    /// laser was on. `record` goes into the first line of a CSV and into Parquet's metadata.
    pub fn create(path: &Path, pairs: bool, record: &str) -> Result<Self> {
        let ending = path.extension().unwrap_or_default();
        let device = std::fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
        if !device && ending != "csv" && ending != "parquet" {
            let expected = "expected a name that ends in .csv or .parquet";
            return Err(Input::new("--events", expected).value(path.display()).into());
        }
        let columns = &COLUMNS[..COLUMNS.len() - usize::from(!pairs)];
        let file = if ending == "parquet" {
            let declared = columns.iter().map(|(name, values)| values.declaration(name));
            let schema = format!("message shots {{ {} }}", declared.collect::<String>());
            let provenance = ("provenance", record.to_owned());
            let fill = |group: &mut RowGroup, shots: &[Shot]| {
                columns.iter().try_for_each(|(_, values)| values.fill(group, shots))
            };
            let file = OutputFile::create(path)?;
            EventFile::Parquet(Box::new(ParquetTable::create(file, &schema, [provenance], fill)?))
        } else {
            let names = columns.iter().map(|(name, _)| *name);
            EventFile::Csv(Box::new(CsvFile::create(path, &format!("# {record}\n"), names)?))
        };
        Ok(Events { path: path.to_owned(), file, columns })
    }

    /// Adds a row.
    pub fn write(&mut self, shot: &Shot) -> Result<()> {
        match &mut self.file {
            EventFile::Csv(file) => {
                file.record(self.columns.iter().map(|(_, values)| values.text(shot)))
            }
            EventFile::Parquet(table) => table.write(&[*shot]),
        }
    }

    /// Puts the file in place, and returns its path.
    pub fn finish(self) -> Result<PathBuf> {
        match self.file {
            EventFile::Csv(file) => file.finish()?,
            EventFile::Parquet(table) => table.finish()?.commit()?,
        }
        Ok(self.path)
    }
}

/// Femtoseconds as picoseconds with all three decimals.
fn picoseconds(fs: i64) -> String {
    format!("{}{}.{:03}", if fs < 0 { "-" } else { "" }, fs.abs() / 1000, fs.abs() % 1000)
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
