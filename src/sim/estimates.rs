//! Estimates as the firmware's estimators compute them, bit for bit, without their clock.

pub mod centroid;
mod estimate;
pub mod likelihood;
mod network;

use crate::firmware::histogram_builder::Count;
use crate::firmware::likelihood_estimator::targets::Targets;
use crate::firmware::tof_top::slot::{EstimateWords, SlotEstimator, SlotIn};
use crate::kernel::U;

pub use estimate::{EchoDepth, Estimate, Pedestal, digits};

/// An estimator that is computed without its clock, too.
pub trait Clockless: SlotEstimator {
    /// Returns the targets that it looks for.
    fn targets(_: &Self::Params) -> Targets {
        Targets::One
    }

    /// The estimate of a histogram whose shots were all armed (MODE 0); by the block itself, where the estimator has no
    /// shorter way.
    fn estimate(p: &Self::Params, histogram: &[u32]) -> EstimateWords {
        let (mut block, mut count) = (Self::default(), Count::default());
        let mut i = SlotIn { algo_start: true, count, ..SlotIn::default() };
        for _ in 0..=Self::cycles(p) {
            block.rise(&SlotIn { count, ..i }.into(), p);
            i.algo_start = false;
            count = U::new(histogram[block.outputs().read_addr.index()].into());
        }
        block.outputs().words
    }

    /// Lands in the cycle before `algo_done` from the first cycle of an estimation of `words`; `idle` is the word at
    /// the port while none is read.
    fn land(&mut self, words: &[Count], _idle: Count, mode: bool, p: &Self::Params) {
        for _ in 1..Self::cycles(p) {
            let count = words[self.outputs().read_addr.index()];
            self.rise(&SlotIn { mode, count, ..SlotIn::default() }.into(), p);
        }
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
