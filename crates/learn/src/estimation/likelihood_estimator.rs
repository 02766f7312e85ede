//! Maximum likelihood in integers as an estimator: what the firmware's block would say.

use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::sim::estimates::likelihood::estimate;

use super::estimator::{Estimator, Failure, Found};

/// Its name on the command line.
pub const NAME: &str = "likelihood_estimator";

/// The estimator for the histograms of one instrument; a depth that it does not believe is a failure.
#[derive(Clone, Debug)]
pub struct LikelihoodEstimator(Params);

impl LikelihoodEstimator {
    /// By the parameters and ROMs that the instrument has, as `Setup::likelihood` gives them.
    pub fn new(params: Params) -> Self {
        LikelihoodEstimator(params)
    }
}

impl Estimator for LikelihoodEstimator {
    fn name(&self) -> &'static str {
        NAME
    }

    fn estimate(&self, histogram: &[u32]) -> Result<f64, Failure> {
        Ok(self.find(histogram)?.depth_m)
    }

    fn find(&self, histogram: &[u32]) -> Result<Found, Failure> {
        let found = estimate(&self.0, histogram);
        let sigma_m = Some(found.sigma_m());
        if found.status.is_empty() {
            Ok(Found { depth_m: found.depth.to_f64(), sigma_m, second: None })
        } else {
            Err(Failure::Rejected(found.status))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::Run;
    use tofsim::sim::setup::Setup;

    #[test]
    fn what_is_not_believed_is_a_failure_in_words() {
        let setup = Setup::load("kc705", &[]).unwrap();
        let estimator = LikelihoodEstimator::new(setup.likelihood(30_000).unwrap());
        let failure = estimator.estimate(&[0; 256]).unwrap_err().to_string();
        assert!(failure.starts_with("no echo"), "{failure}");
        let frames = Run::new(&setup).frames(1).unwrap();
        let depth_m = estimator.estimate(&frames[0].histogram).unwrap();
        assert!((depth_m - 0.5).abs() < 0.002, "{depth_m} m");
    }
}
