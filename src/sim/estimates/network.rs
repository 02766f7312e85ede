//! The network without its clock; its sums are those of [`network::estimate`](crate::network::estimate).

use crate::firmware::depth_estimator::{DepthEstimator, In, Params};
use crate::firmware::estimator_ctrl::EstimatorCtrl;
use crate::firmware::forward1::Forward1;
use crate::firmware::histogram_builder::Count;
use crate::firmware::tof_top::slot::{EstimateWords, SlotEstimator};
use crate::network::Histogram;
use crate::network::estimate::estimate;

use super::Clockless;

impl Clockless for DepthEstimator {
    fn estimate(p: &Params, histogram: &[u32]) -> EstimateWords {
        EstimateWords::of_depth(estimate(p, histogram).depth)
    }

    /// The hidden layer's sums at once, and then the plain step.
    fn land(&mut self, words: &[Count], idle: Count, _: bool, p: &Params) {
        let histogram: Histogram = words.iter().map(|word| word.get() as u32).collect();
        let ctrl = p.ctrl();
        self.estimator_ctrl = EstimatorCtrl::at(ctrl.tansig(), &ctrl);
        self.forward1 = Forward1::at_rest(estimate(p, &histogram).l1_in, idle, &p.forward1);
        for _ in ctrl.tansig() + 1..ctrl.done() {
            self.rise(&In { rst: false, algo_start: false, count: idle }, p);
        }
    }
}
