//! The products of residual, weight and shares.

use crate::firmware::likelihood_estimator::params::Params;
use crate::kernel::{S, U, wrapped};

use super::{In, LikelihoodPair};

/// Half of the 12 bits that are cut off a product.
const HALF: i64 = 1 << 11;

impl LikelihoodPair {
    /// The operands of three multipliers, their products, and where these go.
    pub(super) fn multiply(&self, i: &In, p: &Params, d: &mut Self) {
        let weight_bits = p.weight_bits();
        let weight = |value: i64| U::new((value >> 12) as u64 & ((1 << weight_bits) - 1));
        (d.first_a, d.first_b) = match i.phase {
            true => (S::new(i.weight_first.get() as i64), S::new(self.shares[3].get() as i64)),
            false => (S::new(i.residual.get()), S::new(self.shares[2].get() as i64)),
        };
        d.first_product = S::new(self.first_a.get() * self.first_b.get());
        let first = self.first_product.get() + HALF;
        let second_b = if i.phase { self.still_share } else { self.echo_shares[2] };
        (d.second_a, d.second_b) = (self.once, S::new(second_b.get() as i64));
        d.second_product = S::new(self.second_a.get() as i64 * self.second_b.get());
        let second = self.second_product.get() + HALF;
        if i.phase {
            d.once = weight(first);
            d.square = weight(second);
            (d.third_a, d.third_b) = (self.both, self.z[3]);
            d.both_z = self.third_product;
        } else {
            d.seen = S::new(wrapped(first >> 12, p.histogram.count_bits + 9));
            d.both = weight(second);
            let product = self.third_a.get() as i64 * self.third_b.get();
            d.third_product = S::new(wrapped(product, weight_bits + 9));
        }
    }
}
