//! Second opinion: another estimator's depth from the same histogram, by which a wrong depth is detected without
//! knowing the truth.

use crate::error::Input;
use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::tof_top::FirmwareEstimator;
use crate::network::file::Accuracy;
use crate::note::{Note, NoteCode, NoteValue};
use crate::optics::budget::LIGHT_M_S;
use crate::scenario::effects::Method;
use crate::sensor::light::Light;

use super::estimates::Estimate;
use super::estimates::likelihood::estimate;
use super::frames::Frame;
use super::setup::Setup;

/// Name of the estimator that gives second opinions.
pub const ESTIMATOR: &str = "likelihood_estimator";
/// Depths part that are further from each other than so many of their standard deviations.
const MOST_DEVIATIONS: f64 = 6.0;
/// Standard deviation of a depth of which nobody says how exact it is [bins].
const UNKNOWN_BINS: f64 = 0.5;

/// The estimator of second opinions, for the frames of a scenario.
#[derive(Clone, Debug)]
pub struct SecondOpinion {
    params: Params,
    /// Whether a dark frame comes before each lit one, and says nothing of the target.
    has_pairs: bool,
    socket: Socket,
}

/// The firmware's estimator.
#[derive(Clone, Debug)]
struct Socket {
    name: &'static str,
    /// How exact it is, if its file says.
    accuracy: Option<Accuracy>,
    /// Length of a bin [m].
    bin_m: f64,
}

impl SecondOpinion {
    /// For the frames of `setup`.
    ///
    /// # Errors
    /// When the estimator's model does not hold for them: why not, as a note.
    pub fn new(setup: &Setup) -> Result<Self, Note> {
        if let (Light::List(_) | Light::None, Some(why)) = (&setup.light, setup.no_depth()) {
            return Err(why.clone());
        }
        if let Some(found) = setup.obstacles(Method::SecondOpinion).next() {
            let expected = format!("{}: {}", found.expected(), found.effect.why());
            return Err(none(found.key, found.value, &expected));
        }
        let params = setup.likelihood(setup.shots(1)).map_err(|fault| refused(&fault))?;
        let estimator = setup.params.estimator;
        let is_network = estimator == FirmwareEstimator::Network;
        let accuracy = setup.network.accuracy.clone().filter(|_| is_network);
        let bin_m = setup.scenario.tdc.bin_ps * 1e-12 * LIGHT_M_S / 2.0;
        let socket = Socket { name: estimator.name(), accuracy, bin_m };
        Ok(SecondOpinion { params, has_pairs: setup.has_pairs(), socket })
    }

    /// The estimate for a frame; none for the dark one of a pair.
    pub fn of(&self, frame: &Frame) -> Option<Estimate> {
        if self.has_pairs && !frame.laser_en {
            return None;
        }
        Some(self.of_histogram(&frame.histogram))
    }

    /// The estimate for a histogram of such a frame, whoever made it.
    pub fn of_histogram(&self, histogram: &[u32]) -> Estimate {
        let found = estimate(&self.params, histogram);
        let words = Estimate::of_words(FirmwareEstimator::LikelihoodEstimator, &found.words());
        Estimate { chi_square: Some(found.chi_square()), ..words }
    }

    /// Name of the estimator in the firmware's slot.
    pub fn socket(&self) -> &'static str {
        self.socket.name
    }

    /// Largest accepted difference between the depth of that estimator and a second opinion: six standard deviations
    /// [m].
    pub fn allowed_m(&self, opinion: &Estimate) -> f64 {
        let (depth_m, sigma_m) =
            (opinion.depth_m.unwrap_or(f64::NAN), opinion.sigma_m.unwrap_or(0.0));
        MOST_DEVIATIONS * sigma_m.hypot(self.socket.deviation_m(depth_m))
    }
}

impl Socket {
    /// Standard deviation of what it says of a target at `depth_m`: that of the network's file, with its mean
    /// error, straight between its distances and as at the nearest one beyond them; half a bin where no file
    /// says it [m].
    fn deviation_m(&self, depth_m: f64) -> f64 {
        let unknown_m = UNKNOWN_BINS * self.bin_m;
        let Some(accuracy) = &self.accuracy else { return unknown_m };
        let at = |column: &[f64]| straight(&accuracy.distances_m, column, depth_m);
        let mean_mm = accuracy.mean_mm.as_deref().map_or(Some(0.0), at);
        let (Some(two_sd_mm), Some(mean_mm)) = (at(&accuracy.two_sd_mm), mean_mm) else {
            return unknown_m;
        };
        1e-3 * (two_sd_mm / 2.0).hypot(mean_mm)
    }
}

/// The value at `place` of what is known at some places, in rising order.
fn straight(places: &[f64], values: &[f64], place: f64) -> Option<f64> {
    let after = places.partition_point(|known| *known < place);
    let (low, high) = (after.saturating_sub(1), after.min(places.len().checked_sub(1)?));
    let (from, to) = (*values.get(low)?, *values.get(high)?);
    let width = places[high] - places[low];
    let part = if width > 0.0 { (place - places[low]) / width } else { 0.0 };
    Some(from + part * (to - from))
}

/// Returns the note that there is no second opinion because of the value of `key`.
fn none(key: &str, value: NoteValue, expected: &str) -> Note {
    let text = format!("there is no second opinion by {ESTIMATOR}");
    Note::new(NoteCode::SecondOpinion, key, value, expected, text)
}

fn refused(fault: &Input) -> Note {
    let value = fault.value.as_deref().unwrap_or_default();
    let value = value.parse().map_or_else(|_| value.into(), |number: f64| number.into());
    let expected = fault.expected.trim_start_matches("expected ");
    none(fault.field.as_deref().unwrap_or_default(), value, expected)
}

#[cfg(test)]
mod tests;
