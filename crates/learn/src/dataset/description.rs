//! Metadata of a dataset's files.

use serde::Serialize;

use tofsim::optics::Camera;
use tofsim::scenario::Scenario;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;

use super::axis::Axis;
use super::format::DatasetFormat;
use super::label::Label;
use super::rows::Rows;
use super::source::HistogramSource;

/// Origin of a dataset; with it and a row's number and seed, the row can be made again.
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
    /// Hash of the resolved scenario.
    pub hash: String,
    /// The verb and the options that made it, but for those that only say where it goes.
    pub command: Vec<String>,
    /// Carry chain whose bins these are.
    pub profile: String,
    /// The grid: the thesis's `train` or `test`, or `own`.
    pub grid: &'static str,
    /// The axes of a grid of one's own, distance, irradiance, reflectance and then other keys, the last
    /// one changing fastest but for repeats.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axes: Option<Vec<Axis>>,
    /// Histograms of each scene, where that is not five.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repeats: Option<u64>,
    /// Whether the scenes are a random choice from the grid, or all of it.
    pub subset: bool,
    /// Number of histograms.
    pub rows: u64,
    /// Seed of every random stream.
    pub seed: u64,
    /// The pixels, of an array.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub array: Option<ArrayDescription>,
    /// Shots of a histogram; none where the grid has several numbers of them.
    pub shots_per_frame: Option<u32>,
    /// Columns with the scene of each histogram, of every file that has them.
    pub labels: Vec<Label>,
    /// All keys of the scenario; those of the grid are not used.
    pub settings: Scenario,
}

/// Pixels of a dataset, by row from the top, then column from the left.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ArrayDescription {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// The camera that they are, as `tofsim image` states it.
    pub geometry: Option<Camera>,
}

impl ArrayDescription {
    fn of(array: &ArraySetup) -> Self {
        let [rows, columns] = array.size();
        ArrayDescription { rows, columns, geometry: array.camera() }
    }
}

impl DatasetDescription {
    /// Bytes of a count in a file.
    pub(super) fn count_bytes(&self) -> usize {
        if self.settings.firmware.count_bits > 16 { 4 } else { 2 }
    }

    /// Of the rows that a source, made of `setup`, draws with a seed for a command, to be written in some formats.
    pub fn new(
        setup: &Setup,
        (command, formats): (&[String], &[DatasetFormat]),
        source: &HistogramSource,
        rows: &Rows,
        seed: u64,
    ) -> Self {
        let (settings, grid) = (source.scenario().clone(), rows.grid());
        DatasetDescription {
            schema: "tofsim.dataset/1",
            version: env!("CARGO_PKG_VERSION"),
            scenario: setup.name.clone(),
            set: setup.set.clone(),
            hash: setup.hash(),
            command: command.to_vec(),
            profile: settings.tdc.profile.clone(),
            grid: grid.name,
            axes: (!grid.is_thesis()).then(|| grid.axes().cloned().collect()),
            repeats: (grid.repeats != 5).then_some(grid.repeats),
            subset: matches!(rows, Rows::Subset(_)),
            rows: rows.count(),
            seed,
            array: source.array().map(ArrayDescription::of),
            shots_per_frame: source.shots_of_all(),
            labels: Label::list(formats, grid, rows.count(), settings.tdc.bins),
            settings: Scenario { seed, ..settings },
        }
    }
}
