//! Labels of a dataset: the scene of each histogram, as columns of its files.

use serde::Serialize;

use tofsim::scenario::keys::keys;

use super::axis::Axis;
use super::format::DatasetFormat;
use super::grid::Grid;

/// A column with the true value of a key for each histogram.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Label {
    /// Name of the column.
    pub name: String,
    /// Key of the scenario.
    pub key: String,
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
        let names = grid.labels();
        let known = keys();
        let unit = |key: &str| {
            let schema = known.iter().find(|(known, _)| known == key);
            schema.and_then(|(_, schema)| schema["unit"].as_str()).unwrap_or("1").to_owned()
        };
        let of_format = |format: &DatasetFormat| {
            let (file, before, after) = format.labels(bins);
            let shape = [rows, before + names.len() as u64 + after];
            let label = |(index, (name, axis)): (usize, &(&str, &Axis))| Label {
                name: (*name).to_owned(),
                key: axis.key.clone(),
                unit: unit(&axis.key),
                file,
                column: before as usize + index,
                shape,
            };
            names.iter().enumerate().map(label).collect::<Vec<_>>()
        };
        formats.iter().flat_map(of_format).collect()
    }
}
