//! Slides the box, and keeps the highest place.

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::pipeline::shift;
use crate::firmware::likelihood_estimator::words::{ADDED, NO_SCORE};
use crate::kernel::{S, U};

use super::{In, Kept, Registers};

impl Registers {
    /// Begins a scan.
    pub(super) fn begin(&mut self, p: &Params) {
        (self.count, self.entered) = (U::new(0), false);
        (self.oldest, self.centre) = (S::new(-(p.box_bins as i64)), S::new(-(p.box_back() as i64)));
        self.boxed = [false; 4];
        (self.from, self.until) = Default::default();
        (self.excess[0], self.box_expected, self.box_middle) = Default::default();
        self.best_score = S::new(i64::from(i16::MIN) / 4);
    }

    /// Takes a bin, and what leaves the box for it.
    pub(super) fn enter(&self, i: &In, p: &Params, kept: &Kept, d: &mut Self) {
        d.entered = i.slide;
        if !i.slide {
            return;
        }
        let added = if i.waits { ADDED } else { 0 };
        d.entering_excess = S::new((i.residual.get() << 4) - added);
        d.entering_expected = U::new((i.predicted.get() >> 4) + added as u64);
        d.entering_middle = i.middle;
        let left = if self.oldest.get() >= 0 { *kept } else { Kept::default() };
        d.leaving_excess = left.excess;
        (d.leaving_expected, d.leaving_middle) = (left.predicted, left.middle);
        d.newest = U::new(self.count.get() % p.histogram.bins as u64);
        d.count = self.count + 1;
        (d.oldest, d.centre) = (self.oldest + 1, self.centre + 1);
    }

    /// Adds what enters to the box, and in the second cycle of a beat subtracts what leaves.
    pub(super) fn change(&self, i: &In, d: &mut Self) {
        (d.held_excess, d.held_expected) = (self.excess[0], self.box_expected);
        d.held_middle = self.box_middle[0];
        if !self.entered {
            return;
        }
        let more = |enters: i64, leaves: i64| if i.phase { -leaves } else { enters };
        d.excess[0] = self.excess[0] + more(self.entering_excess.get(), self.leaving_excess.get());
        let [entering, leaving] =
            [self.entering_expected, self.leaving_expected].map(|word| word.get() as i64);
        d.box_expected = self.box_expected + more(entering, leaving) as u64;
        let [entering, leaving] =
            [self.entering_middle, self.leaving_middle].map(|word| word.get() as i64);
        d.box_middle[0] = self.box_middle[0] + more(entering, leaving) as u64;
    }

    /// Slides the box on.
    pub(super) fn slide(&self, p: &Params, d: &mut Self) {
        (d.excess[1], d.excess[2], d.excess[3]) =
            (self.held_excess, self.excess[1], self.excess[2]);
        (d.box_middle[1], d.box_middle[2], d.box_middle[3]) =
            (self.held_middle, self.box_middle[1], self.box_middle[2]);
        // The box ends with the bin that entered.
        let bins = p.histogram.bins as i64;
        shift(&mut d.from, U::new(self.oldest.get().max(0) as u64));
        shift(&mut d.until, U::new(self.count.get().min(bins as u64)));
        shift(&mut d.boxed, self.entered && (0..bins).contains(&self.centre.get()));
    }

    /// Compares a box with the highest one.
    pub(super) fn judge(&self, d: &mut Self) {
        let above = self.excess[2].get() > 0;
        let score = 2 * self.upper_log.get() - self.lower_log.get() - 512;
        d.score = S::new(if above { score } else { NO_SCORE });
        if self.boxed[3] && self.score.get() > self.best_score.get() {
            (d.best_score, d.best_from, d.best_until) = (self.score, self.from[3], self.until[3]);
            (d.best_excess, d.best_middle) = (self.excess[3], self.box_middle[3]);
        }
    }
}
