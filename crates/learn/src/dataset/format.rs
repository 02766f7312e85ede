//! File formats of a dataset, and where their files have the labels.

/// Name of the table in a dataset's folder.
pub(super) const TABLE: &str = "dataset.parquet";
/// Name of the array with the labels.
pub(super) const TRUTH_ARRAY: &str = "truth.npy";

/// File format of a dataset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DatasetFormat {
    /// One table, dataset.parquet
    Parquet,
    /// Arrays: histograms.npy, truth.npy and rows.npy
    Npy,
}

impl DatasetFormat {
    /// Returns the name of the file with the labels, and the numbers of columns before and after them for histograms of
    /// so many bins.
    pub(super) fn labels(self, bins: u64) -> (&'static str, u64, u64) {
        match self {
            // Row number and seed come first.
            DatasetFormat::Parquet => (TABLE, 2, bins),
            DatasetFormat::Npy => (TRUTH_ARRAY, 0, 0),
        }
    }
}
