//! Notes on what an estimator's model has and a scenario does not.
//!
//! The effects that a model does not have stand in the simulator's table ([`tofsim::scenario::effects`]); here are
//! the limits of estimators' own constants. The limits of a network are those of its training.

mod model_check;
mod pedestal;

use tofsim::Note;
use tofsim::firmware::centroid_estimator::CentroidEstimator;
use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::firmware::tof_top::slot::Assumptions;
use tofsim::scenario::effects::Method;
use tofsim::sim::setup::Setup;

use super::in_firmware::InFirmware;
use super::peak_detection::PeakDetection;
use super::registry::EstimatorKind;

use model_check::{ModelCheck, OPTION};
pub use pedestal::PedestalWatch;

impl EstimatorKind {
    /// Returns the estimator's model, as the table of effects has it; `None` for networks.
    fn model(self) -> Option<Method> {
        match self {
            EstimatorKind::NetworkFloat => None,
            EstimatorKind::Likelihood => Some(Method::Likelihood),
            EstimatorKind::TwoEchoes => Some(Method::TwoEchoes),
            EstimatorKind::Matched => Some(Method::Matched),
            EstimatorKind::Peak | EstimatorKind::Subtraction => Some(Method::Peak),
            in_firmware => in_firmware.assumptions().and_then(|assumed| match assumed {
                Assumptions::Training => None,
                Assumptions::Peak => Some(Method::Centroid),
                Assumptions::Model => Some(Method::LikelihoodEstimator),
            }),
        }
    }

    /// Returns notes on what the estimator's model does not have, whatever the scene.
    pub fn notes(self, setup: &Setup) -> Vec<Note> {
        let check = ModelCheck { name: self.name(), setup };
        let effects = self.model().into_iter().flat_map(|model| check.effects(model));
        let own = match self {
            EstimatorKind::Likelihood => [check.dead_time(), None],
            EstimatorKind::Centroid => [check.window(), check.scale()],
            EstimatorKind::Peak | EstimatorKind::Subtraction => {
                [check.pulse_width(), check.thesis_bins()]
            }
            _ => [None, None],
        };
        effects.chain(own.into_iter().flatten()).collect()
    }

    /// Returns the same notes, and those on the scene of the scenario: what the estimator finds in the expected
    /// histogram.
    pub fn notes_of_scene(self, setup: &Setup) -> Vec<Note> {
        let check = ModelCheck { name: self.name(), setup };
        let of_scene = match self {
            EstimatorKind::Likelihood | EstimatorKind::TwoEchoes => {
                check.first_bin().or_else(|| check.first_edge())
            }
            EstimatorKind::Matched => check.first_bin(),
            EstimatorKind::Centroid => check.expected(
                &InFirmware::<CentroidEstimator>::of(FirmwareEstimator::Centroid, setup),
                "pile-up shifts the centroid short",
            ),
            EstimatorKind::Peak => check.range().or_else(|| {
                let detection = PeakDetection::of_bins(check.shots(), &setup.bins());
                let why = "its straight line has no term for signal and background";
                check.expected(&detection, why)
            }),
            EstimatorKind::Subtraction => check.range(),
            _ => None,
        };
        self.notes(setup).into_iter().chain(of_scene).collect()
    }
}

/// Returns the notes on the estimator in the firmware: those that `--estimator` would give.
pub fn notes_of_firmware(setup: &Setup) -> Vec<Note> {
    let mut notes = EstimatorKind::in_socket(&setup.scenario).notes_of_scene(setup);
    for note in notes.iter_mut().filter(|note| note.key == OPTION) {
        "estimator.kind".clone_into(&mut note.key);
        "network".clone_into(&mut note.expected);
    }
    notes
}

#[cfg(test)]
mod tests;
