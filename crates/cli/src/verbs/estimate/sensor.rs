//! Histograms of somebody's own sensor: bins of any number and width, seen by estimators whose model is of light alone.

use std::path::{Path, PathBuf};

use serde_json::json;

use tofsim::error::{Input, Result};
use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::optics::Bins;
use tofsim::scenario;
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode};
use tofsim_learn::dataset::sensor::Layout;
use tofsim_learn::estimation::{EstimatorKind, Panel};

use crate::report::estimates::{EstimateFindings, Numbers, Row};
use crate::report::writer::Report;
use crate::verbs::terminal::Console;

/// What is asked for, of a sensor that may be anybody's.
pub(super) struct Request<'a> {
    pub files: &'a [PathBuf],
    pub estimators: &'a [EstimatorKind],
    /// Whether something asks for the estimator of the firmware.
    pub wants_firmware: bool,
    /// Keys of the default scenario that are set; `None` for another scenario.
    pub set: Option<&'a [String]>,
    pub json: bool,
}

/// A sensor that is not the scenario's.
pub(super) struct Sensor {
    layout: Layout,
    bins: Bins,
}

impl Sensor {
    /// The sensor of the histograms, if they are not those of the scenario's firmware; `layout` is that of the first file,
    /// `None` of a pipe.
    ///
    /// # Errors
    /// When its bins are of no known width.
    pub fn of(asked: &Request, layout: Option<Layout>, setup: &Setup) -> Result<Option<Self>> {
        let Some(layout) = layout else { return Ok(None) };
        let Some(bins) = layout.even_bins() else {
            check_bins(&asked.files[0], layout, setup)?;
            // No network is for so many: what needs none sees them.
            let has_network = setup.params.estimator != FirmwareEstimator::Network
                || setup.network.fits(&setup.params.histogram);
            let may = !has_network && !asked.wants_firmware;
            return Ok(may.then(|| Sensor { layout, bins: setup.known_bins() }));
        };
        Ok(Some(Sensor { layout, bins }))
    }

    /// Estimates the depths of all files.
    pub fn run(&self, asked: &Request, setup: &Setup, console: &Console) -> Result<()> {
        let usual = [EstimatorKind::Likelihood];
        let kinds = if asked.estimators.is_empty() { &usual[..] } else { asked.estimators };
        let notes: Vec<_> =
            assumed(asked, setup).chain(kinds.iter().flat_map(|kind| kind.notes(setup))).collect();
        console.print_notes(&notes)?;
        let panel = Panel::of_bins(kinds, setup, &self.bins)?;
        let names: Vec<String> =
            asked.files.iter().map(|file| file.display().to_string()).collect();
        let mut rows = Vec::new();
        for (path, file) in asked.files.iter().zip(&names) {
            for histogram in self.layout.histograms(path, &asked.files[0])? {
                let mut estimates = panel.read(&histogram?);
                let estimate = estimates.remove(0);
                rows.push(Row {
                    index: rows.len(),
                    file,
                    numbers: Numbers { estimate, l1_in: None },
                    second_opinion: None,
                    estimates,
                    explanation: None,
                    likelihood_explanation: None,
                });
            }
        }
        let (count, bin_ps) = (self.bins.count(), self.bins.bin_ps());
        let sensor =
            json!({ "bins": count, "bin_ps": bin_ps, "first_bin_ps": self.bins.first_ps() });
        let several = names.len() > 1;
        let findings =
            EstimateFindings { network: None, sensor: Some(sensor), rows, several, explain: false };
        Report::new(findings, setup, &notes, console).deliver(None, asked.json, console)
    }
}

/// Checks that a file without times has the bins of a scenario.
///
/// # Errors
/// When it has others.
pub(crate) fn check_bins(file: &Path, layout: Layout, setup: &Setup) -> Result<()> {
    let own = setup.params.histogram.bins;
    if layout.bins == own {
        return Ok(());
    }
    let expected = format!(
        "expected {own} as tdc.bins of scenario {} says, or --bin-ps with the width of these",
        setup.name
    );
    Err(Input::new(file.display(), expected).field("bins").value(layout.bins).into())
}

/// Notes on what the default scenario says of these histograms, as nobody else has.
fn assumed(asked: &Request, setup: &Setup) -> impl Iterator<Item = Note> {
    let (firmware, laser) = (&setup.scenario.firmware, &setup.scenario.laser);
    let shots = firmware.shots_per_frame as f64;
    let pulse = "the standard deviation of the pulse as the detector times it";
    let keys = [
        ("firmware.shots_per_frame", shots, "the laser pulses of a histogram"),
        ("laser.pulse_sigma_ps", laser.pulse_sigma_ps, pulse),
    ];
    let is_unset = |key: &str| {
        asked.set.is_some_and(|keys| keys.iter().all(|set| set.split('=').next() != Some(key)))
    };
    let note = |(key, value, meaning): (&str, f64, &str)| {
        let text = format!("taken from scenario {}; it decides depth and sigma", scenario::DEFAULT);
        let expected = format!("{meaning}: -s {key}=..");
        Note::new(NoteCode::EstimatorOutsideModel, key, value, expected, text)
    };
    keys.into_iter().filter(move |(key, ..)| is_unset(key)).map(note)
}
