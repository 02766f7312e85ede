//! One form for every estimate, whoever makes it and wherever it is shown.

use serde::{Serialize, Serializer};

use crate::firmware::depth_estimator::datapath::DEPTH_BITS;
use crate::firmware::likelihood_estimator::words::SIGNAL_FRACTION;
use crate::firmware::tof_top::FirmwareEstimator;
use crate::firmware::tof_top::slot::{DepthM, EstimateWords, SecondWords, SigmaM};
use crate::firmware::tof_top::status::StatusSet;
use crate::firmware::tof_top::status_code::StatusCode;

/// Result of an estimator for a histogram.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Name of the estimator on the command line.
    pub estimator: &'static str,
    /// Distance of the target; null where there is none [m].
    pub depth_m: Option<f64>,
    /// Depth word, from an estimator in integers: 36 bits in hexadecimal.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "as_digits")]
    pub depth_raw: Option<DepthM>,
    /// Standard deviation of the depth; null where the estimator states none [m].
    pub sigma_m: Option<f64>,
    /// Whether the status has no reason to reject the depth.
    pub valid: bool,
    /// Reasons to reject the depth, in words; empty if there are none.
    pub status: StatusSet,
    /// What a host can rely on, from the firmware's likelihood estimator.
    #[serde(skip_serializing_if = "StatusCode::is_unstated")]
    pub status_code: StatusCode,
    /// Sum of squared residuals over their variances, about one a bin of the fit [1].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chi_square: Option<f64>,
    /// Second echo, where the estimator looks for one and has found it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub second: Option<EchoDepth>,
    /// The cover window's light, where the estimator has a template of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pedestal: Option<Pedestal>,
    /// The status in full, where there is no depth.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// Where an echo comes from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EchoDepth {
    /// Distance of what it comes from [m].
    pub depth_m: f64,
    /// Its standard deviation [m].
    pub sigma_m: f64,
    /// Its signal, from the firmware [photons per shot].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub signal_per_shot: Option<f64>,
    /// Whether its status has no reason to reject the distance, from the firmware.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub valid: Option<bool>,
    /// Reasons to reject the distance, in words; empty if there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub status: Option<StatusSet>,
}

impl EchoDepth {
    /// Returns an echo with a distance and its standard deviation alone [m].
    pub fn new(depth_m: f64, sigma_m: f64) -> Self {
        EchoDepth { depth_m, sigma_m, signal_per_shot: None, valid: None, status: None }
    }

    /// Returns the second target in words of the firmware, if there is one.
    pub fn of_words(second: &SecondWords) -> Option<Self> {
        let is_there = second.second_sigma != 0;
        is_there.then(|| EchoDepth {
            depth_m: DepthM::from_bits(second.second_depth.get()).to_num(),
            sigma_m: SigmaM::from_bits(second.second_sigma.get()).to_num(),
            signal_per_shot: Some(
                second.second_strength.get() as f64 / f64::from(1 << SIGNAL_FRACTION),
            ),
            valid: Some(second.second_valid),
            status: Some(second.second_status.into()),
        })
    }
}

/// The light of a cover window beside its template.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pedestal {
    /// Its amplitude; 1: as calibrated [1].
    pub relative: f64,
    /// Standard error of the amplitude; 0 if the histogram shows no such light [1].
    pub relative_se: f64,
    /// Sum of squared residuals in the template's bins beyond their number, in its own standard deviations; large if the
    /// light has another shape [1].
    pub misfit: f64,
}

impl Estimate {
    /// An estimate of which only the depth is known.
    pub fn of_depth(estimator: &'static str, depth_m: Option<f64>) -> Self {
        Estimate {
            estimator,
            depth_m,
            depth_raw: None,
            sigma_m: None,
            valid: depth_m.is_some(),
            status: StatusSet::default(),
            status_code: StatusCode::Unstated,
            chi_square: None,
            second: None,
            pedestal: None,
            failure: None,
        }
    }

    /// The estimate in words of the firmware. One that states no status is valid.
    pub fn of_words(estimator: FirmwareEstimator, words: &EstimateWords) -> Self {
        let (depth, states) = (words.depth_m(), estimator.states_sigma());
        Estimate {
            depth_raw: Some(depth),
            sigma_m: states.then(|| words.sigma_m().to_num()),
            valid: words.valid || !states,
            status: words.status.into(),
            status_code: words.code,
            second: EchoDepth::of_words(&words.second),
            ..Estimate::of_depth(estimator.estimator(), Some(depth.to_num()))
        }
    }

    /// Returns why the depth is rejected: the code, if the estimator states one, and the reasons; `None` if it is valid.
    pub fn rejection(&self) -> Option<String> {
        let (code, reasons) = (self.status_code, self.status.to_string());
        let text = if code.is_unstated() || code.word() == reasons {
            reasons
        } else {
            format!("{} ({reasons})", code.word())
        };
        (!self.valid).then_some(text)
    }
}

/// Nine hexadecimal digits of a depth word.
fn as_digits<S: Serializer>(depth: &Option<DepthM>, serializer: S) -> Result<S::Ok, S::Error> {
    depth.map(digits).serialize(serializer)
}

/// A depth word's 36 bits in hexadecimal.
pub fn digits(depth: DepthM) -> String {
    format!("{:09x}", depth.to_bits() & ((1 << DEPTH_BITS) - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::forward2::Depth;
    use crate::firmware::tof_top::status::Status;
    use crate::kernel::U;

    #[test]
    fn an_estimate_has_what_its_words_state() {
        let status = U::new((Status::CutOff.bit() | Status::NoFit.bit()).into());
        let (depth, sigma) = (Depth::new(0x1013_c199), U::new(1 << 19));
        let code = StatusCode::CutOff;
        let words = EstimateWords { depth, sigma, status, code, ..EstimateWords::default() };
        let json = |words| {
            serde_json::to_value(Estimate::of_words(FirmwareEstimator::LikelihoodEstimator, words))
        };
        let expected = serde_json::json!({
            "estimator": "likelihood_estimator",
            "depth_m": depth.to_f64(),
            "depth_raw": "01013c199",
            "sigma_m": 2f64.powi(-10),
            "valid": false,
            "status": ["cut off by the window", "no fit"],
            "status_code": "cut off by the window",
        });
        assert_eq!(json(&words).unwrap(), expected);
        let estimate = Estimate::of_words(FirmwareEstimator::LikelihoodEstimator, &words);
        let text = "cut off by the window (cut off by the window, no fit)";
        assert_eq!(estimate.rejection().as_deref(), Some(text));
        let code = StatusCode::Valid;
        let clear = EstimateWords { status: U::new(0), valid: true, code, ..words };
        let found = json(&clear).unwrap();
        assert_eq!((&found["valid"], &found["status"]), (&true.into(), &serde_json::json!([])));
    }

    #[test]
    fn an_estimator_without_a_status_is_valid_and_states_no_sigma() {
        for estimator in [FirmwareEstimator::Network, FirmwareEstimator::Centroid] {
            let words = EstimateWords::of_depth(Depth::new(1 << 28));
            let found = Estimate::of_words(estimator, &words);
            let Estimate { depth_m, sigma_m, valid, status, .. } = found;
            assert_eq!((depth_m, sigma_m, valid), (Some(0.5), None, true));
            assert!(status.is_empty());
        }
    }
}
