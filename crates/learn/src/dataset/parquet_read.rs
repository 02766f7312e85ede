//! A dataset from Parquet, with columns of whole numbers in 32 or 64 bits.

use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use parquet::basic::Type as Physical;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::schema::types::SchemaDescriptor;

use tofsim::error::{Error, Input, Result};
use tofsim::firmware::histogram_builder::BINS;

use super::blocks::Sample;
use super::checks::{Fault, check_total, check_truth};
use super::parquet_file::{HEAD, bin_name};
use super::scene::Scene;

/// Values read at a time.
const CHUNK: usize = 1 << 14;

/// Reads a file.
pub(super) fn read(path: &Path) -> Result<Vec<Sample>> {
    let file = File::open(path).map_err(Error::io(path, "read"))?;
    // Where the library panics over a damaged file after all, that is an error too.
    let read = catch_unwind(AssertUnwindSafe(|| {
        let file = SerializedFileReader::new(file).map_err(|error| damaged(path, error))?;
        let columns = columns(path, file.metadata().file_metadata().schema_descr())?;
        let mut samples = Vec::new();
        for group in 0..file.num_row_groups() {
            let reader = file.get_row_group(group).map_err(|error| damaged(path, error))?;
            let group = Group { path, columns: &columns, reader, first: samples.len() };
            group.read(&mut samples)?;
        }
        Ok(samples)
    }));
    read.unwrap_or_else(|_| Err(damaged(path, "its pages are not as its header says")))
}

/// A column of the file that is one of ours.
struct Column {
    name: String,
    /// Place in the file.
    place: usize,
}

/// Whether the column at that place of ours has fractions.
fn is_real(column: usize) -> bool {
    (2..HEAD.len()).contains(&column)
}

/// The columns of [`HEAD`], then those of the bins.
fn columns(path: &Path, schema: &SchemaDescriptor) -> Result<Vec<Column>> {
    let is_bin = |name: &str| name.strip_prefix('b').is_some_and(|k| k.parse::<usize>().is_ok());
    let bins = schema.columns().iter().filter(|column| is_bin(column.name())).count();
    if bins != BINS {
        let expected =
            format!("expected {BINS} columns, {} to {}", bin_name(0), bin_name(BINS - 1));
        return Err(Input::new(path.display(), expected).field("bins").value(bins).into());
    }
    let names = HEAD.map(str::to_owned).into_iter().chain((0..BINS).map(bin_name));
    names.enumerate().map(|(k, name)| column(path, schema, name, is_real(k))).collect()
}

/// The column of that name, which has to be of numbers, one a row.
fn column(path: &Path, schema: &SchemaDescriptor, name: String, is_real: bool) -> Result<Column> {
    let kinds = if is_real { "DOUBLE" } else { "INT32 or INT64" };
    let place = schema.columns().iter().position(|column| column.path().string() == name);
    let Some(place) = place else {
        let missing = Input::new(path.display(), format!("missing, expected {kinds}"));
        return Err(missing.field(format!("column {name}")).into());
    };
    let found = schema.column(place);
    let fits = match found.physical_type() {
        Physical::DOUBLE => is_real,
        Physical::INT32 | Physical::INT64 => !is_real,
        _ => false,
    };
    if !fits || found.max_rep_level() > 0 || found.max_def_level() > 1 {
        let wrong = Input::new(path.display(), format!("expected {kinds}"));
        let field = format!("type of column {name}");
        return Err(wrong.field(field).value(found.physical_type()).into());
    }
    Ok(Column { name, place })
}

/// Rows that are stored together.
struct Group<'a> {
    path: &'a Path,
    columns: &'a [Column],
    reader: Box<dyn RowGroupReader + 'a>,
    /// Rows before these.
    first: usize,
}

impl Group<'_> {
    /// Appends the rows.
    fn read(&self, samples: &mut Vec<Sample>) -> Result<()> {
        let rows = self.whole(0)?;
        let scene = Scene { distance_m: 0.0, reflectance: 0.0, irradiance_w_m2_nm: 0.0 };
        let sample = |&row: &i64| Sample { seed: 0, row: row as u64, scene, histogram: [0; BINS] };
        samples.extend(rows.iter().map(sample));
        let new = &mut samples[self.first..];
        self.put(new, self.whole(1)?, |sample, seed| sample.seed = seed as u64)?;
        self.put(new, self.real(2)?, |sample, value| sample.scene.distance_m = value)?;
        self.put(new, self.real(3)?, |sample, value| sample.scene.reflectance = value)?;
        self.put(new, self.real(4)?, |sample, value| sample.scene.irradiance_w_m2_nm = value)?;
        for bin in 0..BINS {
            let counts = self.counts(HEAD.len() + bin)?;
            self.put(new, counts, |sample, count| sample.histogram[bin] = count)?;
        }
        for (k, sample) in new.iter().enumerate() {
            let checked = check_truth(&sample.scene).and(check_total(&sample.histogram));
            checked.map_err(|fault| self.fault(k, fault))?;
        }
        Ok(())
    }

    /// Puts the values of a column into rows, which have to be as many.
    fn put<T>(
        &self,
        samples: &mut [Sample],
        values: Vec<T>,
        put: impl Fn(&mut Sample, T),
    ) -> Result<()> {
        if values.len() != samples.len() {
            return Err(damaged(self.path, "columns of different lengths"));
        }
        samples.iter_mut().zip(values).for_each(|(sample, value)| put(sample, value));
        Ok(())
    }

    /// The counts of a bin.
    fn counts(&self, column: usize) -> Result<Vec<u16>> {
        let count = |(row, value): (usize, i64)| {
            u16::try_from(value).map_err(|_| {
                let name = format!("column {}", self.columns[column].name);
                let expected = "expected a whole number from 0 to 65535".to_owned();
                self.fault(row, (name, value.to_string(), expected))
            })
        };
        self.whole(column)?.into_iter().enumerate().map(count).collect()
    }

    fn fault(&self, row: usize, (field, value, expected): Fault) -> Error {
        let field = format!("row {}, {field}", self.first + row);
        Input::new(self.path.display(), expected).field(field).value(value).into()
    }

    fn whole(&self, column: usize) -> Result<Vec<i64>> {
        match self.open(column)? {
            ColumnReader::Int32ColumnReader(reader) => {
                Ok(self.all(column, reader)?.into_iter().map(i64::from).collect())
            }
            ColumnReader::Int64ColumnReader(reader) => self.all(column, reader),
            _ => Err(damaged(self.path, "types differ from group to group")),
        }
    }

    fn real(&self, column: usize) -> Result<Vec<f64>> {
        match self.open(column)? {
            ColumnReader::DoubleColumnReader(reader) => self.all(column, reader),
            _ => Err(damaged(self.path, "types differ from group to group")),
        }
    }

    fn open(&self, column: usize) -> Result<ColumnReader> {
        let place = self.columns[column].place;
        let stored = self.reader.metadata().column(place);
        let dictionary = stored.dictionary_page_offset().unwrap_or(0);
        // The library panics over these.
        if stored.data_page_offset().min(dictionary).min(stored.compressed_size()) < 0 {
            return Err(damaged(self.path, "a column with a negative place or size"));
        }
        self.reader.get_column_reader(place).map_err(|error| damaged(self.path, error))
    }

    /// All values of a column, none of which may be missing.
    fn all<T: DataType>(
        &self,
        column: usize,
        mut reader: ColumnReaderImpl<T>,
    ) -> Result<Vec<T::T>> {
        let (mut values, mut defined) = (Vec::new(), Vec::new());
        loop {
            let read = reader.read_records(CHUNK, Some(&mut defined), None, &mut values);
            let (records, ..) = read.map_err(|error| damaged(self.path, error))?;
            if records == 0 {
                break;
            }
        }
        match defined.iter().position(|&level| level == 0) {
            None => Ok(values),
            Some(row) => {
                let name = format!("column {}", self.columns[column].name);
                Err(self.fault(row, (name, "null".to_owned(), "expected a number".to_owned())))
            }
        }
    }
}

fn damaged(path: &Path, error: impl std::fmt::Display) -> Error {
    Input::new(path.display(), format!("unreadable Parquet: {error}")).into()
}
