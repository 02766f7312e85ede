//! A dataset as Parquet: a column for each bin, as data frames have it.
//!
//! Columns: `row`, `seed`, `distance_m`, `reflectance`, `irradiance_w_m2_nm`, `b0` .. `b255`. What
//! the file is about stands in its metadata under [`KEY`], as JSON.

use std::path::Path;

use parquet::data_type::{DoubleType, Int32Type, Int64Type};

use tofsim::error::Result;
use tofsim::files::output::OutputFile;
use tofsim::firmware::histogram_builder::BINS;

use super::blocks::Sample;
use super::parquet_table::{GROUP, ParquetTable};

/// Key of the description in the file's metadata.
pub const KEY: &str = "tofsim.dataset";
/// Name of the file in a dataset's folder.
pub const NAME: &str = "dataset.parquet";
/// Columns before the bins.
const HEAD: &str =
    "required int64 row (INTEGER(64,false)); required int64 seed (INTEGER(64,false));
    required double distance_m; required double reflectance; required double irradiance_w_m2_nm;";

/// A Parquet file under construction; nothing is left of it unless it is finished and put in place.
pub struct ParquetFile {
    table: ParquetTable,
    /// Rows gathered for the next group.
    samples: Vec<Sample>,
}

impl ParquetFile {
    /// Begins the file; `description` goes into its metadata.
    pub fn create(path: &Path, description: &str) -> Result<Self> {
        let file = OutputFile::create(path)?;
        let table = ParquetTable::create(file, &schema(), KEY, description.to_owned())?;
        Ok(ParquetFile { table, samples: Vec::with_capacity(GROUP) })
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
        if !self.samples.is_empty() {
            self.flush()?;
        }
        self.table.finish()
    }

    fn flush(&mut self) -> Result<()> {
        let rows = || self.samples.iter();
        self.table.write_group(|group| {
            group.required::<Int64Type>(rows().map(|sample| sample.row as i64))?;
            group.required::<Int64Type>(rows().map(|sample| sample.seed as i64))?;
            group.required::<DoubleType>(rows().map(|sample| sample.scene.distance_m))?;
            group.required::<DoubleType>(rows().map(|sample| sample.scene.reflectance))?;
            group.required::<DoubleType>(rows().map(|sample| sample.scene.irradiance_w_m2_nm))?;
            (0..BINS).try_for_each(|bin| {
                group.required::<Int32Type>(rows().map(|sample| sample.histogram[bin].into()))
            })
        })?;
        self.samples.clear();
        Ok(())
    }
}

fn schema() -> String {
    let bin = |bin| format!("required int32 b{bin} (INTEGER(16,false)); ");
    format!("message dataset {{ {HEAD} {} }}", (0..BINS).map(bin).collect::<String>())
}
