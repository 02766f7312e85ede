//! The sums: where they begin, and what a bin adds to them.

use crate::firmware::likelihood_estimator::words::{AMBIENT_RIDGE, RIDGE};
use crate::kernel::{S, U};

use super::{In, LikelihoodSums};

impl LikelihoodSums {
    /// Sets the sums to their ridges.
    pub(super) fn clear(&mut self, check: bool) {
        self.last_sum = S::new(if check { 0 } else { AMBIENT_RIDGE });
        self.sum_11 = S::new(2 * RIDGE);
        (self.sum_12, self.sum_13) = (S::new(0), S::new(0));
        (self.sum_22, self.sum_23) = (S::new(RIDGE), S::new(0));
        (self.score_1, self.score_2, self.score_3) = (S::new(0), S::new(0), S::new(0));
        (self.far, self.changed) = (false, false);
        // What is on the way from a pass that was no check is no square.
        (self.square, self.reciprocal, self.twice_first) = Default::default();
    }

    /// Adds a bin.
    pub(super) fn accumulate(&self, i: &In, d: &mut Self) {
        d.sum_33 = S::new(self.last_sum.get());
        if i.check {
            d.chi_square = U::new(self.last_sum.get() as u64);
        }
        d.changed = i.phase;
        if i.phase || self.changed {
            let added = |second: i64, first: i64| if i.phase { second } else { first };
            d.sum_12 = self.sum_13 + added(self.oz.get(), self.tz.get());
            d.score_1 = self.sum_11 + added(self.tzz.get(), self.seen_z.get());
            d.sum_22 = self.sum_23 + added(self.mixed.get(), self.twice.get() as i64);
            d.score_2 = self.score_3 + added(self.unseen.get(), self.seen.get());
            // Of the last one w (1 - s) comes first, and then w s (1 - s) leaves it.
            d.last_sum = self.last_sum
                + match (i.check, i.phase) {
                    (true, _) => added(self.twice.get() as i64, 0),
                    (false, true) => self.others.get(),
                    (false, false) => -self.mixed.get(),
                };
            (d.sum_13, d.sum_11) = (self.sum_12, self.score_1);
            (d.sum_23, d.score_3) = (self.sum_22, self.score_2);
        }
    }
}
