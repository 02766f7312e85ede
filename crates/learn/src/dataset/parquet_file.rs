//! A dataset as Parquet: a column for each bin, as data frames have it.
//!
//! Columns: `row`, `seed`, `distance_m`, `reflectance`, `irradiance_w_m2_nm`, the other keys of the grid,
//! `b0` .. `b255`. What the file is about stands in its metadata under [`KEY`], as JSON.

use std::path::Path;

use parquet::data_type::{DoubleType, Int32Type, Int64Type};

use tofsim::error::Result;
use tofsim::files::output::OutputFile;

use super::axis::Axis;
use super::blocks::Sample;
use super::description::DatasetDescription;
use super::grid::Grid;
use super::parquet_table::ParquetTable;

/// Key of the description in the file's metadata.
const KEY: &str = "tofsim.dataset";
/// Columns before the bins.
const HEAD: &str =
    "required int64 row (INTEGER(64,false)); required int64 seed (INTEGER(64,false));
    required double distance_m; required double reflectance; required double irradiance_w_m2_nm;";

/// Begins the file; `text`, of the description, goes into its metadata, `grid` has the other keys.
pub(super) fn create(
    path: &Path,
    (description, text): (&DatasetDescription, &str),
    grid: &Grid,
) -> Result<ParquetTable<Sample>> {
    let other = |axis: &Axis| format!("required double {}; ", axis.key);
    let others: String = grid.others.iter().map(other).collect();
    let grid = grid.clone();
    let bins = description.settings.tdc.bins as usize;
    let width = description.count_bytes() * 8;
    let column = |bin| format!("required int32 b{bin} (INTEGER({width},false)); ");
    let columns: String = (0..bins).map(column).collect();
    let schema = format!("message dataset {{ {HEAD} {others} {columns} }}");
    let file = OutputFile::create(path)?;
    ParquetTable::create(file, &schema, [(KEY, text.to_owned())], move |group, rows: &[Sample]| {
        let rows = || rows.iter();
        group.required::<Int64Type>(rows().map(|sample| sample.row as i64))?;
        group.required::<Int64Type>(rows().map(|sample| sample.seed as i64))?;
        group.required::<DoubleType>(rows().map(|sample| sample.scene.distance_m))?;
        group.required::<DoubleType>(rows().map(|sample| sample.scene.reflectance))?;
        group.required::<DoubleType>(rows().map(|sample| sample.scene.irradiance_w_m2_nm))?;
        (0..grid.others.len()).try_for_each(|k| {
            let of = |sample: &Sample| grid.setting(sample.scene.setting)[k].1;
            group.required::<DoubleType>(rows().map(of))
        })?;
        (0..bins).try_for_each(|bin| {
            group.required::<Int32Type>(rows().map(|sample| sample.histogram[bin] as i32))
        })
    })
}
