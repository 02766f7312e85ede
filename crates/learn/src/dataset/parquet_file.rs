//! A dataset as Parquet: a column for each bin, as data frames have it.
//!
//! Columns: `row`, `seed`, `distance_m`, `reflectance`, `irradiance_w_m2_nm`, of an array `pixel_row` and `pixel_column`,
//! the other keys of the grid, `b0` .. `b255`. What the file is about stands in its metadata under [`KEY`], as JSON.

use std::path::Path;

use parquet::data_type::{DoubleType, Int32Type, Int64Type};

use tofsim::error::Result;
use tofsim::files::output::OutputFile;

use super::blocks::Sample;
use super::description::DatasetDescription;
use super::grid::Grid;
use super::parquet_table::ParquetTable;
use super::scene_columns::SceneColumn;

/// Key of the description in the file's metadata.
const KEY: &str = "tofsim.dataset";
/// Columns before the scene.
const HEAD: &str =
    "required int64 row (INTEGER(64,false)); required int64 seed (INTEGER(64,false));";

/// Begins the file; `text`, of the description, goes into its metadata, `grid` has the other keys.
pub(super) fn create(
    path: &Path,
    (description, text): (&DatasetDescription, &str),
    grid: &Grid,
) -> Result<ParquetTable<Sample>> {
    let scene = |SceneColumn { name, is_index, .. }: &SceneColumn| match is_index {
        true => format!("required int32 {name} (INTEGER(32,false)); "),
        false => format!("required double {name}; "),
    };
    let scenes: String = grid.columns().iter().map(scene).collect();
    let grid = grid.clone();
    let bins = description.settings.tdc.bins as usize;
    let width = description.count_bytes() * 8;
    let column = |bin| format!("required int32 b{bin} (INTEGER({width},false)); ");
    let columns: String = (0..bins).map(column).collect();
    let schema = format!("message dataset {{ {HEAD} {scenes} {columns} }}");
    let file = OutputFile::create(path)?;
    ParquetTable::create(file, &schema, [(KEY, text.to_owned())], move |group, rows: &[Sample]| {
        let rows = || rows.iter();
        group.required::<Int64Type>(rows().map(|sample| sample.row as i64))?;
        group.required::<Int64Type>(rows().map(|sample| sample.seed as i64))?;
        let values: Vec<_> = rows().map(|sample| grid.values(&sample.scene)).collect();
        grid.columns().iter().enumerate().try_for_each(|(k, column)| {
            let values = values.iter().map(|of_row| of_row[k]);
            match column.is_index {
                true => group.required::<Int32Type>(values.map(|index| index as i32)),
                false => group.required::<DoubleType>(values),
            }
        })?;
        (0..bins).try_for_each(|bin| {
            group.required::<Int32Type>(rows().map(|sample| sample.histogram[bin] as i32))
        })
    })
}
