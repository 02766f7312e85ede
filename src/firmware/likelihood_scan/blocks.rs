//! Keeps the blocks of bins with the lowest hazards.

use crate::firmware::likelihood_estimator::pipeline::shift;
use crate::firmware::likelihood_estimator::words::LEAST_EXPOSURE;
use crate::kernel::S;

use super::{In, Registers};

impl Registers {
    /// Keeps the blocks with the lowest hazards.
    pub(super) fn blocks(&self, i: &In, d: &mut Self) {
        shift(&mut d.block, i.block_done);
        d.held_exposure = i.block_exposure;
        if i.block_done {
            d.block_count = self.block_count + 1;
        }
        if self.block[4] {
            self.insert(d);
        }
        if i.load {
            (d.block_count, d.judged, d.exposed) = Default::default();
            d.lowest = [S::new(8191); 3];
            d.threshold = S::new(-8192);
        }
    }

    /// Puts a block into its place.
    fn insert(&self, d: &mut Self) {
        let (hazard, exposure) =
            (self.upper_log.get() - self.lower_log.get(), self.lower_log.get());
        d.judged = self.judged + 1;
        let first = self.judged == 0;
        if first {
            d.threshold = S::new(exposure - LEAST_EXPOSURE);
        }
        if !first && exposure <= self.threshold.get() {
            return;
        }
        d.exposed = self.exposed + 1;
        let lower = |k: usize| hazard < self.lowest[k].get();
        for k in 0..3 {
            if k > 0 && lower(k - 1) {
                (d.lowest[k], d.which[k]) = (self.lowest[k - 1], self.which[k - 1]);
            } else if lower(k) {
                (d.lowest[k], d.which[k]) = (S::new(hazard), self.judged);
            }
        }
    }
}
