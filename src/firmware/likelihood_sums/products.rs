//! The operands of the four multipliers, and where their products go.

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::pipeline::shift;
use crate::firmware::likelihood_estimator::words::FAR;
use crate::kernel::{S, U, wrapped};

use super::{COUNT, In, LikelihoodSums};

/// Half of the 12 bits that are cut off a product, to round it.
const HALF: i64 = 1 << 11;

impl LikelihoodSums {
    /// Registers the four products. Their destination in the first cycle of a beat is kept for the second.
    pub(super) fn multiply(&self, i: &In, p: &Params, d: &mut Self) {
        self.front_operands(i, p, d);
        self.back_operands(i, d);
        d.first_product = S::new(self.first_a.get() * self.first_b.get());
        d.second_product = S::new(self.second_a.get() * self.second_b.get());
        d.third_product = S::new(self.third_a.get() * self.third_b.get());
        d.fourth_product = S::new(self.fourth_a.get() * self.fourth_b.get());

        let first = self.first_product.get() + if i.phase { 0 } else { 2 * HALF };
        let second = self.second_product.get() + if i.check && !i.phase { 0 } else { HALF };
        let third = self.third_product.get() + if i.check || i.phase { 0 } else { HALF };
        let fourth = self.fourth_product.get() + if i.check { FAR * COUNT } else { 0 };
        let (count_bits, weight_bits) = (p.histogram.count_bits, p.weight_bits());
        let weight = |value: i64| U::new(value as u64 & ((1 << weight_bits) - 1));
        let slope = |value: i64| S::new(wrapped(value, weight_bits + 9));
        d.weight_first = weight(first >> 13);
        d.square_first = U::new((second >> 2) as u64 & ((1 << (2 * count_bits)) - 1));
        d.seen_first = S::new(wrapped(second >> 12, count_bits + 9));
        (d.twice_first, d.tz_first) = (weight(third >> 12), slope(fourth));
        if i.phase {
            shift(&mut d.once, weight(second >> 12));
            d.seen_z = S::new(wrapped(first, count_bits + 18));
            (d.oz, d.tzz, d.tz) = (slope(third), slope(fourth), self.tz_first);
        }
    }

    /// A weight, then a share of the residual times its slope; a share of the residual or its square, then a share
    /// of the weight.
    fn front_operands(&self, i: &In, p: &Params, d: &mut Self) {
        if i.phase {
            (d.first_a, d.first_b) = (self.seen_first, S::new(self.z[0].get()));
            d.second_a = S::new(self.weight_first.get() as i64);
            d.second_b = S::new(self.shares[0].get() as i64);
            return;
        }
        let predicted = (i.predicted.get() >> 5).min((1 << (p.histogram.count_bits + 8)) - 1);
        (d.first_a, d.first_b) = (S::new(predicted as i64), S::new(i.gain.get() as i64));
        let most = (1 << (p.histogram.count_bits + 1)) - 1;
        let near = i.residual.get().clamp(-most, most);
        d.second_a = S::new(if i.check { near } else { i.residual.get() });
        d.second_b = S::new(if i.check { near } else { i.share.get() as i64 });
    }

    /// A share of that share or a term of the chi-square, then the other share times its slope; a share of the share
    /// times its slope, and times it again, or how far a square may be.
    fn back_operands(&self, i: &In, d: &mut Self) {
        let (twice, [.., z_4, z_5]) = (self.twice.get() as i64, self.z.map(|z| z.get()));
        let (third_a, third_b) = match (i.phase, i.check) {
            (true, _) => (self.once[2].get() as i64 - twice, z_4),
            (_, true) => (self.over.get() as i64, (self.reciprocal.get() << 2) as i64),
            _ => (self.once[0].get() as i64, self.shares[2].get() as i64),
        };
        let (fourth_a, fourth_b) = match (i.phase, i.check) {
            (_, true) => (self.weight[0].get() as i64, FAR),
            (true, _) => (self.tz_first.get() >> 9, z_5),
            _ => (twice, z_4),
        };
        (d.third_a, d.third_b) = (S::new(third_a), S::new(third_b));
        (d.fourth_a, d.fourth_b) = (S::new(fourth_a), S::new(fourth_b));
    }
}
