//! A row for each shot, as CSV or Parquet.
//!
//! Columns: `frame`, `shot` (both from 0), `arrival_ps` (from the laser edge), `cause`, `n` (ones
//! count), `coarse`, `code`, `bin`; where frames come in pairs also `laser_en` (1 in lit frames). Of images, `row`,
//! `column` and `image` (from 0) stand in place of `frame`. What a shot does not have is empty (CSV) or null
//! (Parquet). A photon that is given has no cause.

use std::path::{Path, PathBuf};

use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int32Type, Int64Type};
use parquet::errors::Result as Written;

use tofsim::error::{Input, Result};
use tofsim::files::csv_output::CsvOutput;
use tofsim::files::output::OutputFile;
use tofsim::optics::hazard::Cause;
use tofsim::sim::shot_recorder::Shot;

use super::parquet_table::{ParquetTable, RowGroup};

/// A shot of a pixel.
#[derive(Clone, Copy)]
struct Event {
    /// Row and column of the pixel.
    place: [usize; 2],
    shot: Shot,
}

/// A column: its name and values.
type Column = (&'static str, Values);

/// Which frame it is of, in a run.
const OF_RUN: [Column; 1] = [("frame", Values::Number(|event| event.shot.frame))];

/// Which pixel and image it is of.
const OF_IMAGES: [Column; 3] = [
    ("row", Values::Number(|event| event.place[0] as u64)),
    ("column", Values::Number(|event| event.place[1] as u64)),
    ("image", Values::Number(|event| event.shot.frame)),
];

/// What each shot has; the last one only where frames come in pairs.
const OF_SHOT: [Column; 8] = [
    ("shot", Values::Number(|event| event.shot.shot)),
    ("arrival_ps", Values::Time(|event| event.shot.arrival_fs)),
    ("cause", Values::Word(|event| event.shot.cause.map(Cause::word))),
    ("n", Values::Count(|event| event.shot.n)),
    ("coarse", Values::Count(|event| event.shot.coarse)),
    ("code", Values::Count(|event| event.shot.code)),
    ("bin", Values::Count(|event| event.shot.code)),
    ("laser_en", Values::Flag(|event| event.shot.laser_en)),
];

/// The values of a column.
#[derive(Clone, Copy)]
enum Values {
    /// A number that every shot has.
    Number(fn(&Event) -> u64),
    /// A time, if there is one [fs].
    Time(fn(&Event) -> Option<i64>),
    /// A word, if there is one.
    Word(fn(&Event) -> Option<&'static str>),
    /// A number, if there is one.
    Count(fn(&Event) -> Option<u64>),
    /// A level that every shot has.
    Flag(fn(&Event) -> bool),
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
    fn fill(self, group: &mut RowGroup, events: &[Event]) -> Written<()> {
        let events = events.iter();
        match self {
            Values::Number(of) => group.required::<Int64Type>(events.map(|event| of(event) as i64)),
            Values::Time(of) => group
                .optional::<DoubleType>(events.map(|event| of(event).map(|fs| fs as f64 / 1e3))),
            Values::Word(of) => {
                group.optional::<ByteArrayType>(events.map(|event| of(event).map(ByteArray::from)))
            }
            Values::Count(of) => group
                .optional::<Int32Type>(events.map(|event| of(event).map(|number| number as i32))),
            Values::Flag(of) => group.required::<BoolType>(events.map(of)),
        }
    }

    /// Returns the value of a shot, as CSV has it.
    fn text(self, event: &Event) -> String {
        match self {
            Values::Number(of) => of(event).to_string(),
            Values::Time(of) => of(event).map_or(String::new(), picoseconds),
            Values::Word(of) => of(event).unwrap_or_default().to_owned(),
            Values::Count(of) => of(event).map_or(String::new(), |number| number.to_string()),
            Values::Flag(of) => u8::from(of(event)).to_string(),
        }
    }
}

/// The file under construction; nothing is left of it unless [`ShotFile::finish`] is called.
pub struct ShotFile {
    path: PathBuf,
    file: Format,
    columns: Vec<Column>,
}

enum Format {
    Csv(Box<CsvOutput>),
    Parquet(Box<ParquetTable<Event>>),
}

impl ShotFile {
    /// Begins the file of a run; its ending decides the format. With `pairs` it says of each shot whether the
    /// laser was on. `record` goes into the first line of a CSV and into Parquet's metadata.
    pub fn of_run(path: &Path, pairs: bool, record: &str) -> Result<Self> {
        ShotFile::create(path, &OF_RUN, pairs, record)
    }

    /// Begins the file of images, as [`ShotFile::of_run`] does.
    pub fn of_images(path: &Path, record: &str) -> Result<Self> {
        ShotFile::create(path, &OF_IMAGES, false, record)
    }

    fn create(path: &Path, first: &[Column], pairs: bool, record: &str) -> Result<Self> {
        let ending = path.extension().unwrap_or_default();
        let device = std::fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
        if !device && ending != "csv" && ending != "parquet" {
            let expected = "expected a name that ends in .csv or .parquet";
            return Err(Input::new("--events", expected).value(path.display()).into());
        }
        let columns = [first, &OF_SHOT[..OF_SHOT.len() - usize::from(!pairs)]].concat();
        let file = if ending == "parquet" {
            let declared = columns.iter().map(|(name, values)| values.declaration(name));
            let schema = format!("message shots {{ {} }}", declared.collect::<String>());
            let provenance = ("provenance", record.to_owned());
            let filled = columns.clone();
            let fill = move |group: &mut RowGroup, events: &[Event]| {
                filled.iter().try_for_each(|(_, values)| values.fill(group, events))
            };
            let file = OutputFile::create(path)?;
            Format::Parquet(Box::new(ParquetTable::create(file, &schema, [provenance], fill)?))
        } else {
            let names = columns.iter().map(|(name, _)| *name);
            Format::Csv(Box::new(CsvOutput::create(path, &format!("# {record}\n"), names)?))
        };
        Ok(ShotFile { path: path.to_owned(), file, columns })
    }

    /// Adds a shot of a pixel, which is that at row and column 0 in a run.
    pub fn write(&mut self, place: [usize; 2], shot: &Shot) -> Result<()> {
        let event = Event { place, shot: *shot };
        match &mut self.file {
            Format::Csv(file) => {
                file.record(self.columns.iter().map(|(_, values)| values.text(&event)))
            }
            Format::Parquet(table) => table.write(&[event]),
        }
    }

    /// Puts the file in place, and returns its path.
    pub fn finish(self) -> Result<PathBuf> {
        match self.file {
            Format::Csv(file) => file.finish()?,
            Format::Parquet(table) => table.finish()?.commit()?,
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
