//! What a dataset's files say about themselves.

use serde::Serialize;

use tofsim::scenario::Scenario;

use super::rows::Rows;
use super::source::HistogramSource;

/// Where a dataset comes from; with it, and with a row's number and seed, the row can be made again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DatasetDescription {
    /// `tofsim.dataset/1`.
    pub schema: &'static str,
    /// Version of the program.
    pub version: &'static str,
    /// The scenario's name.
    pub scenario: String,
    /// Keys of the scenario that were set otherwise.
    pub set: Vec<String>,
    /// Carry chain whose bins these are.
    pub profile: String,
    /// The grid: `train` or `test`.
    pub grid: &'static str,
    /// Whether the scenes are a random choice from the grid, or all of it.
    pub subset: bool,
    /// Number of histograms.
    pub rows: u64,
    /// Seed of every random stream.
    pub seed: u64,
    /// Shots of a histogram.
    pub shots_per_frame: u16,
    /// All keys of the scenario; distance, reflectance and irradiance are not used.
    pub settings: Scenario,
}

impl DatasetDescription {
    /// Of the rows that a source draws with a seed. `scenario` is its name.
    pub fn new(
        scenario: &str,
        set: &[String],
        source: &HistogramSource,
        rows: &Rows,
        seed: u64,
    ) -> Self {
        let settings = source.scenario().clone();
        DatasetDescription {
            schema: "tofsim.dataset/1",
            version: env!("CARGO_PKG_VERSION"),
            scenario: scenario.to_owned(),
            set: set.to_vec(),
            profile: settings.tdc.profile.clone(),
            grid: rows.grid().name,
            subset: matches!(rows, Rows::Subset(_)),
            rows: rows.count(),
            seed,
            shots_per_frame: source.shots(),
            settings: Scenario { seed, ..settings },
        }
    }
}
