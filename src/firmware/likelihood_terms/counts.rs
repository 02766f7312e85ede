//! The shots that end in a bin beside those that are expected to, and the outputs that go with them.

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::pipeline::shift;
use crate::kernel::{S, U};

use super::{In, LikelihoodTerms};

/// Bits of the largest hazard.
const MOST_BITS: u64 = 26;

impl LikelihoodTerms {
    /// Delays the values that accompany a bin.
    pub(super) fn carry(&self, i: &In, p: &Params, d: &mut Self) {
        shift(&mut d.bin, i.word_bin);
        shift(&mut d.rest, i.word_rest);
        shift(&mut d.slides, i.word_slide);
        shift(&mut d.edge_alone, i.word_edge);
        shift(&mut d.first, i.word_first);
        shift(&mut d.ended, i.word_ended);
        shift(&mut d.waiting, i.word_waiting);
        shift(&mut d.width, i.word_width);
        let [waiting, ended] =
            [self.waiting[11], self.ended[11]].map(|shots| shots.get() & p.histogram.most_hits());
        let middle = if self.bin[11] { (2 * waiting).saturating_sub(ended) } else { 0 };
        shift(&mut d.middles, U::new(middle));
        let any = self.bin[11] || self.rest[11];
        shift(&mut d.awaited, any && self.waiting[11] != 0);
    }

    /// Shots, those that end in the first cycle of a beat and those that wait in the second, and half of what is cut
    /// off each product.
    pub(super) fn multiply(&self, i: &In, d: &mut Self) {
        (d.shots, d.factor) = match i.phase {
            true => (self.waiting[11], U::new(self.mantissa[2].get())),
            false => (self.ended[11], self.k),
        };
        d.shots_product = U::new(self.shots.get() * self.factor.get());
        d.half = U::new(match i.phase {
            true => 128,
            false => 23_u64.checked_sub(self.bits[4].get()).map_or(0, |bit| 1 << bit),
        });
        let times = self.shots_product.get() + self.half.get();
        d.ended_k_first = U::new(times);
        if i.phase {
            d.product = U::new(times);
            shift(&mut d.ended_k, self.ended_k_first);
        }
    }

    /// R lambda from its mantissa, and the residual.
    pub(super) fn expect(&self, i: &In, p: &Params, d: &mut Self) {
        let (long, short) = (self.down.get() & 24, self.down.get() & 7);
        d.expected_first = U::new((self.product.get() << 2) >> long);
        d.surplus = S::new(self.ended_k[1].get() as i64 - self.product_shifted.get() as i64);
        if i.phase {
            d.down = U::new(MOST_BITS.wrapping_sub(self.bits[4].get()));
            let most = (1 << (p.histogram.count_bits + 18)) - 1;
            d.product_shifted = U::new((self.expected_first.get() >> short).min(most));
        }
    }

    /// Drives the outputs.
    pub(super) fn give(&self, p: &Params, d: &mut Self) {
        let any = self.bin[14] || self.rest[14];
        let most = 1 << (p.histogram.count_bits + 8);
        let residual = (self.surplus.get() >> 8).clamp(-most, most - 1);
        d.residual = S::new(if any { residual } else { 0 });
        d.predicted = if any { self.product_shifted } else { U::new(0) };
        d.gain = self.gains[2];
        (d.share, d.slope) = (self.shares[2], self.z[11]);
        (d.middle, d.waits) = (self.middles[2], self.awaited[2]);
        (d.single, d.slide) = (self.bin[14], self.slides[14]);
    }
}
