//! Labels of a dataset: the scene of each histogram, as columns of its files.

use serde::Serialize;

use tofsim::scenario::keys::keys;

use super::format::DatasetFormat;
use super::grid::{DISTANCE, Grid};
use super::scene_columns::SceneColumn;

/// A column with a true value for each histogram, most of them of a key of the scenario.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Label {
    /// Name of the column.
    pub name: String,
    /// Key of the scenario; none of the depth and the place of an array's pixel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
    /// Unit of the values; `1` of ratios and counts.
    pub unit: String,
    /// Name of the file in the dataset's folder.
    pub file: &'static str,
    /// Index of the column in the file, from 0.
    pub column: usize,
    /// Rows and columns of the file.
    pub shape: [u64; 2],
}

impl Label {
    /// Lists the labels of a grid's histograms, in the order of the columns, for each format in turn.
    pub(super) fn list(formats: &[DatasetFormat], grid: &Grid, rows: u64, bins: u64) -> Vec<Self> {
        let columns = grid.columns();
        let known = keys();
        let unit = |column: &SceneColumn| {
            let key = column.key.unwrap_or(if column.is_index { "" } else { DISTANCE });
            let schema = known.iter().find(|(known, _)| known == key);
            schema.and_then(|(_, schema)| schema["unit"].as_str()).unwrap_or("1").to_owned()
        };
        let of_format = |format: &DatasetFormat| {
            let (file, before, after) = format.labels(bins);
            let shape = [rows, before + columns.len() as u64 + after];
            let label = |(index, column): (usize, &SceneColumn)| Label {
                name: column.name.to_owned(),
                key: column.key.map(str::to_owned),
                unit: unit(column),
                file,
                column: before as usize + index,
                shape,
            };
            columns.iter().enumerate().map(label).collect::<Vec<_>>()
        };
        formats.iter().flat_map(of_format).collect()
    }
}
