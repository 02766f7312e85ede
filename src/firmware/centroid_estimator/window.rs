//! The window that slides over the histogram, and the sums over it.

use crate::kernel::{S, U};

use super::params::{Params, SUMS};
use super::{CentroidEstimator, In, Registers, WORDS};

impl CentroidEstimator {
    /// Takes this cycle's word and those of the window that ends before it.
    pub(super) fn look(&self, i: &In, p: &Params, d: &mut Registers) {
        let q = &self.registers;
        let first = self.window[q.first.index()];
        d.whole = q.step.get() >= 2 * p.half_width;
        d.first = if q.whole { q.first + 1 } else { U::new(1) };
        d.entering = if q.read_en { i.count } else { U::new(0) };
        d.leaving = if q.whole { first } else { U::new(0) };
        d.level = if !p.background {
            U::new(0)
        } else if q.whole {
            first
        } else {
            U::new((2 * first.get()).min(p.histogram.most_hits()))
        };
        d.centre = self.window[(q.step - p.half_width).index() % WORDS];
    }
}

impl Registers {
    /// Makes of those words what the sums need.
    pub(super) fn weigh(&self, p: &Params, d: &mut Registers) {
        let centred = self.step.get() > p.half_width + 1;
        let over = self.centre.get().saturating_sub(self.level.get());
        d.change = S::new(self.entering.get() as i64 - self.leaving.get() as i64);
        d.weighted = U::new((2 * p.half_width + 1) * self.leaving.get());
        d.height = U::new(if centred { over } else { 0 });
    }

    /// Keeps the window if its centre is the highest, and slides it on.
    pub(super) fn slide(&self, p: &Params, d: &mut Registers) {
        if self.height.get() > self.best.get() {
            (d.best, d.best_sum) = (self.height, self.sum);
            d.peak = U::new(self.step.get() - SUMS - 1 - p.half_width);
            d.remainder = U::new(self.ages.get());
        }
        d.sum = U::new((self.sum.get() as i64 + self.change.get()) as u64);
        d.ages = self.ages + self.sum.get() - self.weighted.get();
    }
}
