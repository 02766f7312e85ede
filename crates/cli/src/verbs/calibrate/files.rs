//! Files of histograms, of the scenario's firmware or of another sensor.

use std::path::PathBuf;

use tofsim::error::Result;
use tofsim::network::Histogram;
use tofsim::optics::Bins;
use tofsim::sim::setup::Setup;
use tofsim_learn::dataset::labelled::histograms;
use tofsim_learn::dataset::sensor::Layout;
use tofsim_learn::estimation::Acquisition;

use crate::verbs::estimate::{check_bins, load_for};

/// Files of histograms, with the instrument that they are of.
pub(super) struct HistogramFiles<'a> {
    files: &'a [PathBuf],
    sensor: Option<Layout>,
    /// The instrument.
    pub setup: Setup,
    /// Its bins, or those of another sensor.
    pub bins: Bins,
}

impl<'a> HistogramFiles<'a> {
    /// Of a scenario; `bin_ps` is the bin width of another sensor, if it is stated.
    pub fn new(
        files: &'a [PathBuf],
        bin_ps: Option<f64>,
        scenario: &str,
        set: &[String],
    ) -> Result<Self> {
        let layout = Layout::of(&files[0], bin_ps)?;
        let setup = Setup::of_counts(load_for(layout, scenario, set)?)?;
        let sensor = layout.filter(|layout| layout.has_times());
        if let (Some(layout), None) = (layout, sensor) {
            check_bins(&files[0], layout, &setup)?;
        }
        let bins = sensor.and_then(|layout| layout.even_bins());
        let bins = bins.unwrap_or_else(|| setup.known_bins());
        Ok(HistogramFiles { files, sensor, setup, bins })
    }

    /// Reads all histograms, each with its file and its number there.
    pub fn read(&self, acquisition: &Acquisition) -> Result<Vec<(String, usize, Histogram)>> {
        let mut all = Vec::new();
        for path in self.files {
            let found = match self.sensor {
                Some(layout) => layout.histograms(path, &self.files[0])?,
                None => histograms(path, self.setup.params.histogram)?,
            };
            let file = path.display().to_string();
            for (number, histogram) in found.enumerate() {
                let histogram = histogram?;
                acquisition.check_hits(&file, number, &histogram)?;
                all.push((file.clone(), number, histogram));
            }
        }
        Ok(all)
    }
}
