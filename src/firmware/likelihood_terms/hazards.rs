//! The hazards of a bin: their sum, its k, and the signal's share in it.

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::pipeline::shift;
use crate::firmware::likelihood_estimator::tables::{Tables, length};
use crate::firmware::likelihood_estimator::words::{LEAST_HAZARD, MOST_HAZARD, WHOLE};
use crate::kernel::U;

use super::{In, LikelihoodTerms};

/// Bits of a hazard's mantissa.
const MANTISSA_BITS: u32 = 14;

impl LikelihoodTerms {
    /// The hazards: that of the signal begins in the first cycle of a beat, that of ambient light in the second.
    pub(super) fn light_up(&self, i: &In, p: &Params, d: &mut Self) {
        (d.level, d.amount) = match i.phase {
            true => (i.ambient, U::new(2 * self.width[3].get())),
            false => (i.strength, self.part),
        };
        d.level_product = U::new(self.level.get() * self.amount.get());
        d.level_times = U::new(self.level_product.get() + 256);
        d.light = U::new((self.level_times.get() >> 9).min(MOST_HAZARD as u64));
        d.lit_first = self.light;
        if i.phase {
            if p.has_second() {
                d.ambient_light = self.light;
            }
            d.lit = self.lit_first;
            let others = i.glass_light.get() + i.other_light.get();
            d.sum = U::new(self.lit_first.get() + self.light.get() + others);
            shift(
                &mut d.hazard,
                U::new(self.sum.get().clamp(LEAST_HAZARD as u64, MOST_HAZARD as u64)),
            );
            shift(&mut d.signal_hazard, self.lit);
        }
    }

    /// The sum's mantissa, in the first cycle of a beat; in the second the signal's part as it is shifted.
    pub(super) fn normalise(&self, i: &In, d: &mut Self) {
        let bits = self.bits[0].get() as u32;
        let value = if i.phase { self.signal_hazard[1].get() } else { self.hazard[1].get() };
        let aligned = U::new(match bits.checked_sub(MANTISSA_BITS) {
            Some(excess) => value >> excess,
            None => value << (MANTISSA_BITS - bits),
        });
        d.mantissa_first = aligned;
        if i.phase {
            shift(&mut d.bits, U::new(length(self.hazard[0].get() as i64).into()));
            d.hazard_bits = self.bits[0];
            shift(&mut d.mantissa, self.mantissa_first);
            d.aligned = aligned;
        }
    }

    /// Computes the slope of k: it begins in the first cycle of a beat, and the share s in the second.
    pub(super) fn divide(&self, i: &In, d: &mut Self) {
        let hazard = self.hazard[2].get() as i64;
        let mantissa = self.mantissa[0].get() as i64;
        let (few, many) = match i.phase {
            true => (Tables::reciprocal(mantissa, MANTISSA_BITS - 1), self.aligned.get() as i64),
            false => (hazard >> 10 & 1023, Tables::k_growth(hazard)),
        };
        (d.few, d.many, d.triple) =
            (U::new(few as u64), U::new(many as u64), U::new(3 * many as u64));
        let low = self.few.get() & 63;
        let (low, high) = (rows(low, self.many, self.triple), self.few.get() >> 6);
        d.begun = U::new(low);
        (d.few_left, d.many_left, d.triple_left) = (U::new(high), self.many, self.triple);
        let rest = rows(self.few_left.get(), self.many_left, self.triple_left);
        d.grown = U::new(self.begun.get() + (rest << 6));
        let bits = MANTISSA_BITS - 3;
        let rounded = (self.grown.get() >> bits) + (self.grown.get() >> (bits - 1) & 1);
        d.share_first = U::new(rounded.min(WHOLE as u64));
        if i.phase {
            d.hazard_reciprocal = U::new(Tables::reciprocal(mantissa, MANTISSA_BITS - 1) as u64);
            d.k_before = U::new(Tables::k_before(hazard) as u64);
            d.k = self.k_before + (self.grown.get() >> 10 & 2047);
            let lambda = self.hazard[4].get() >> 10;
            shift(&mut d.gains, U::new(self.k.get().wrapping_sub(lambda)));
            shift(&mut d.shares, self.share_first);
        }
    }
}

/// A product in rows, of two bits of the first factor each.
fn rows(few: u64, many: U<17>, triple: U<19>) -> u64 {
    let row = |two: u64| [0, many.get(), 2 * many.get(), triple.get()][two as usize & 3];
    (0..3).map(|place| row(few >> (2 * place)) << (2 * place)).sum()
}
