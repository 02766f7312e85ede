//! What the estimators take for granted, and what of it a scenario does not have.
//!
//! The network's own limits are those of its training; they are not told here.

mod teller;

use tofsim::Note;
use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::sim::setup::Setup;

use super::centroid::Centroid;
use super::peak_detection::PeakDetection;
use super::registry::EstimatorKind;

use teller::{OPTION, Teller};

/// Jitter of an edge that moves centroid and peak by a tenth of a millimetre [ps].
const JITTER_PS: f64 = 20.0;
/// Afterpulses that move centroid and peak by less than a tenth of a millimetre: they come evenly, as ambient
/// light does [1].
const FEW_AFTERPULSES: f64 = 0.01;

impl EstimatorKind {
    /// What this estimator takes for granted and the scenario does not have, whatever the scene.
    pub fn notes(self, setup: &Setup) -> Vec<Note> {
        let teller = Teller { name: self.name(), setup };
        let found = match self {
            EstimatorKind::Network | EstimatorKind::NetworkFloat => vec![],
            EstimatorKind::Likelihood => vec![
                teller.echo(),
                teller.dead_time(),
                teller.row(),
                teller.pulses(0.0, 0.0),
                teller.control(),
                teller.recharge(),
                teller.afterpulses(0.0),
                teller.neighbours(),
                teller.shaping(),
                teller.metastable(),
            ],
            EstimatorKind::TwoEchoes => vec![
                teller.echo(),
                teller.mode(),
                teller.row(),
                teller.pulses(0.0, 0.0),
                teller.control(),
                teller.afterpulses(0.0),
                teller.neighbours(),
                teller.shaping(),
                teller.metastable(),
            ],
            EstimatorKind::LikelihoodEstimator => vec![
                teller.echo(),
                teller.jitter(0.0),
                teller.pulses(0.0, 0.0),
                teller.control(),
                teller.afterpulses(0.0),
                teller.neighbours(),
                teller.shaping(),
                teller.metastable(),
            ],
            EstimatorKind::Matched => vec![
                teller.echo(),
                teller.mode(),
                teller.jitter(0.0),
                teller.pulses(0.0, 0.0),
                teller.control(),
                teller.afterpulses(0.0),
                teller.neighbours(),
                teller.shaping(),
                teller.metastable(),
            ],
            EstimatorKind::Centroid => vec![
                teller.echo(),
                teller.mode(),
                teller.jitter(JITTER_PS),
                teller.pulses(JITTER_PS, f64::INFINITY),
                teller.window(),
                teller.scale(),
                teller.afterpulses(FEW_AFTERPULSES),
                teller.shaping(),
            ],
            EstimatorKind::Peak | EstimatorKind::Subtraction => vec![
                teller.echo(),
                teller.mode(),
                teller.jitter(JITTER_PS),
                teller.pulses(JITTER_PS, f64::INFINITY),
                teller.pulse(),
                teller.thesis_bins(),
                teller.delay(),
                teller.afterpulses(FEW_AFTERPULSES),
                teller.shaping(),
            ],
        };
        found.into_iter().flatten().collect()
    }

    /// The same for the scene of the scenario, too: what the estimator makes of the histogram that
    /// is to be expected.
    pub fn notes_of_scene(self, setup: &Setup) -> Vec<Note> {
        let teller = Teller { name: self.name(), setup };
        let of_scene = match self {
            EstimatorKind::Likelihood | EstimatorKind::TwoEchoes => {
                teller.first_bin().or_else(|| teller.first_edge())
            }
            EstimatorKind::Matched => teller.first_bin(),
            EstimatorKind::Centroid => teller
                .expected(&Centroid(setup.params.centroid_estimator), "pile-up makes it early"),
            EstimatorKind::Peak => teller.range().or_else(|| {
                let detection = PeakDetection::of_bins(teller.shots(), &teller.setup.bins());
                teller.expected(&detection, "its straight line knows neither signal nor background")
            }),
            EstimatorKind::Subtraction => teller.range(),
            _ => None,
        };
        self.notes(setup).into_iter().chain(of_scene).collect()
    }
}

/// What the estimator in the firmware's socket takes for granted of the scenario and its scene; the
/// network's limits are those of its training.
pub fn notes_of_firmware(setup: &Setup) -> Vec<Note> {
    let mut notes = match setup.params.estimator {
        FirmwareEstimator::Network => return Vec::new(),
        FirmwareEstimator::Centroid => EstimatorKind::Centroid.notes_of_scene(setup),
        FirmwareEstimator::Likelihood => {
            let name = EstimatorKind::LikelihoodEstimator.name();
            return Teller { name, setup }.echo().into_iter().collect();
        }
    };
    for note in notes.iter_mut().filter(|note| note.key == OPTION) {
        "estimator.kind".clone_into(&mut note.key);
        "network".clone_into(&mut note.expected);
    }
    notes
}

#[cfg(test)]
mod tests;
