//! Estimates as the firmware's estimators compute them, bit for bit, without their clock. The network's is
//! [`network::estimate`](crate::network::estimate).

pub mod centroid;
mod estimate;
pub mod likelihood;

use crate::firmware::centroid_estimator::CentroidEstimator;
use crate::firmware::depth_estimator::DepthEstimator;
use crate::firmware::likelihood_estimator::LikelihoodEstimator;
use crate::firmware::tof_top::slot::{EstimateWords, SlotEstimator};
use crate::network;

pub use estimate::{EchoDepth, Estimate, digits};

/// An estimator that is computed without its clock, too.
pub trait Clockless: SlotEstimator {
    /// The estimate of a histogram whose shots were all armed (MODE 0).
    fn estimate(p: &Self::Params, histogram: &[u32]) -> EstimateWords;
}

impl Clockless for DepthEstimator {
    fn estimate(p: &Self::Params, histogram: &[u32]) -> EstimateWords {
        EstimateWords::of_depth(network::estimate::estimate(p, histogram).depth)
    }
}

impl Clockless for CentroidEstimator {
    fn estimate(p: &Self::Params, histogram: &[u32]) -> EstimateWords {
        EstimateWords::of_depth(centroid::locate(p, histogram).depth)
    }
}

impl Clockless for LikelihoodEstimator {
    fn estimate(p: &Self::Params, histogram: &[u32]) -> EstimateWords {
        likelihood::estimate(p, histogram).words()
    }
}

#[cfg(test)]
mod tests {
    use crate::firmware::tof_top::FirmwareEstimator;
    use crate::sim::setup::Setup;
    use crate::sim::{Run, Stepping};

    #[test]
    fn the_words_of_a_frame_are_those_of_its_histogram() {
        for &estimator in FirmwareEstimator::ALL {
            let kind = format!("estimator.kind={}", estimator.name());
            for light in ["target.distance_m=0.3", "firmware.laser_en=false"] {
                let set = [&kind, light, "firmware.shots_per_frame=2000"];
                let setup = Setup::load("kc705", &set).unwrap();
                for stepping in [Stepping::SkipIdle, Stepping::LeapShots] {
                    let frame = Run::new(&setup).stepping(stepping).frames(1).unwrap().remove(0);
                    let words = setup.estimate_words(&frame.histogram);
                    assert_eq!((frame.estimator, frame.words), (estimator, words), "{set:?}");
                    let states = estimator.states_sigma();
                    assert_eq!(words.sigma != 0, states, "{set:?}");
                    assert_eq!(words.valid, states && words.status == 0, "{set:?}");
                }
            }
        }
    }
}
