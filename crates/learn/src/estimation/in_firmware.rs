//! An estimator of the firmware, bit for bit.

use tofsim::firmware::likelihood_estimator::LikelihoodEstimator;
use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::firmware::tof_top::slotted::Slotted;
use tofsim::firmware::tof_top::status::StatusSet;
use tofsim::sim::estimates::Clockless;
use tofsim::sim::setup::Setup;

use super::estimator::{EchoDepth, Estimator, Failure, Found, SecondTarget, hits};

/// Name of the second target's distances, of the only estimator that looks for one.
const SECOND: &str = "likelihood_estimator-second";

/// An estimator of the firmware for the histograms of one instrument; a depth that it rejects is a failure.
pub struct InFirmware<E: Clockless> {
    name: &'static str,
    params: E::Params,
}

impl<E: Clockless> InFirmware<E> {
    /// The block `E` with its parameters and ROMs.
    pub fn new(estimator: FirmwareEstimator, params: E::Params) -> Self {
        InFirmware { name: estimator.estimator(), params }
    }
}

impl<E: Clockless + Slotted> InFirmware<E> {
    /// The block `E` as an instrument has it.
    pub fn of(estimator: FirmwareEstimator, setup: &Setup) -> Self {
        InFirmware::new(estimator, E::params(&setup.params).clone())
    }
}

/// The likelihood estimator by the parameters and ROMs that the instrument has, as `Setup::likelihood` gives them.
pub fn likelihood_estimator(params: Params) -> InFirmware<LikelihoodEstimator> {
    InFirmware::new(FirmwareEstimator::LikelihoodEstimator, params)
}

impl<E: Clockless> Estimator for InFirmware<E> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn estimate(&self, histogram: &[u32]) -> Result<f64, Failure> {
        Ok(self.find(histogram)?.depth_m)
    }

    fn find(&self, histogram: &[u32]) -> Result<Found, Failure> {
        if !E::STATES_SIGMA {
            hits(histogram, u32::MAX)?;
        }
        let words = E::estimate(&self.params, histogram);
        if !E::STATES_SIGMA && words.depth.get() == 0 {
            return Err(Failure::NoPeak);
        }
        let status = StatusSet::from(words.status);
        if !status.is_empty() {
            return Err(Failure::Rejected(status));
        }
        let sigma_m = E::STATES_SIGMA.then(|| words.sigma_m().to_num());
        let depth_m = words.depth_m().to_num();
        let second = EchoDepth::of_words(&words.second).filter(|second| second.valid == Some(true));
        Ok(Found { sigma_m, second, ..Found::depth(depth_m) })
    }

    fn second(&self) -> Option<SecondTarget> {
        let targets = E::targets(&self.params);
        targets.has_second().then_some(SecondTarget { name: SECOND, targets })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::Run;
    use tofsim::firmware::centroid_estimator::CentroidEstimator;

    #[test]
    fn what_is_not_believed_is_a_failure_in_words() {
        let setup = Setup::load("kc705", &[]).unwrap();
        let estimator = likelihood_estimator(setup.likelihood(30_000).unwrap());
        let failure = estimator.estimate(&[0; 256]).unwrap_err().to_string();
        assert!(failure.starts_with("no echo"), "{failure}");
        let frames = Run::new(&setup).frames(1).unwrap();
        let depth_m = estimator.estimate(&frames[0].histogram).unwrap();
        assert!((depth_m - 0.5).abs() < 0.002, "{depth_m} m");
    }

    #[test]
    fn a_histogram_without_a_peak_has_no_distance() {
        let setup = Setup::load("kc705", &[]).unwrap();
        let centroid = InFirmware::<CentroidEstimator>::of(FirmwareEstimator::Centroid, &setup);
        assert_eq!(centroid.estimate(&[0; 256]), Err(Failure::NoHits));
        assert_eq!(centroid.estimate(&[100; 256]), Err(Failure::NoPeak));
    }
}
