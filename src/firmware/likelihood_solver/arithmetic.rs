//! The product of two operands, its shift, and the sum within its limits.

use strum::VariantArray;

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::tables::length;
use crate::firmware::likelihood_estimator::words::{LEAST_SIGNAL, MOST_CHANCE, MOST_LEVEL};
use crate::kernel::{S, U, wrapped};

use super::instruction::{By, Clamp, Op};
use super::{LOW_BITS, Registers};

/// Limits of a step in log b or log C: it falls to a half at most, and grows by three times.
const GROWTH: [i64; 2] = [-(1 << 13), 3 << 14];
/// The same while little is known of log b, or the step is shortened: b does not fall then.
const HELD_GROWTH: [i64; 2] = [0, GROWTH[1]];

impl Registers {
    /// The product.
    pub(super) fn multiply(&self, p: &Params, d: &mut Self) {
        let (a, b, low) = (self.a.get(), self.b.get(), (1 << LOW_BITS) - 1);
        let part = if self.at[1] { b & low } else { b >> LOW_BITS };
        d.low_product = S::new((a & low) * part);
        d.high_product = S::new((a >> LOW_BITS) * part);
        let lower = self.low_product.get() + (self.low.get() >> LOW_BITS);
        let upper = self.high_product.get() + (lower >> LOW_BITS);
        let partial = upper.wrapping_shl(LOW_BITS) | lower & low;
        let size = p.word_bits() + 18;
        d.low = S::new(if self.at[2] { wrapped(partial, size) } else { 0 });
        if self.at[3] {
            let whole = partial.wrapping_shl(LOW_BITS) | self.low.get() & low;
            d.product = S::new(whole);
        }
        if self.at[1] && self.instruction(p, 1).op == Op::Reciprocal {
            d.bits = U::new(length(a.max(1)).into());
        }
    }

    /// The product as the instruction shifts it; a divisor is not rounded.
    pub(super) fn shift(&self, p: &Params, d: &mut Self) {
        let by = match By::VARIANTS[self.by.index() % By::VARIANTS.len()] {
            By::Nothing => 0,
            By::Bits => self.bits.get(),
            By::Exponent => self.exponent.get(),
            By::Cut => self.cut.get(),
            By::Both => self.bits.get() + self.exponent.get(),
            By::Metres => p.metres_shift.into(),
        };
        d.shift = U::new((self.base.get() + by).min(63));
        d.shift_low = U::new(self.shift.get() & 15);

        let width = p.word_bits() + 2;
        let down = (i128::from(self.product.get()) << 1) >> (self.shift.get() & 48);
        let most = 1 << (width + 15);
        d.coarse = S::new(wrapped(down as i64, width + 16));
        d.negative = down < 0;
        d.coarse_fits = (-most..most).contains(&down);
        if !self.at[5] {
            return;
        }
        let fine = self.coarse.get() >> self.shift_low.get();
        let sign = if self.negative { -(1 << (width - 1)) } else { 0 };
        d.shifted = S::new(sign + (fine >> 1 & ((1 << (width - 1)) - 1)));
        d.half = fine & 1 != 0 && self.alu;
        // One place is left for the rounding.
        let most = 1 << (width - 1);
        let same = (fine < 0) == self.negative;
        d.beyond = !(self.coarse_fits && same && (-most..most).contains(&fine));
    }

    /// The sum, and its limits.
    pub(super) fn add(&self, p: &Params, d: &mut Self) {
        let (c, shifted) = (self.c.get(), self.shifted.get() + i64::from(self.half));
        d.sum = S::new(if self.minus { c - shifted } else { c + shifted });
        (d.past, d.opposite) = (self.beyond, (self.shifted.get() < 0) != self.minus);
        d.limits = U::new(self.instruction(p, 6).clamp as u64);

        let [least, most] = match Clamp::VARIANTS[self.limits.index()] {
            Clamp::Growth if self.scarce || self.cut != 0 => HELD_GROWTH,
            clamp => p.limits(clamp),
        };
        d.result = S::new(match (self.divided, self.past, self.opposite) {
            (true, ..) => self.quotient.get() as i64,
            (_, true, true) => least,
            (_, true, false) => most,
            _ => self.sum.get().clamp(least, most),
        });
    }
}

impl Params {
    /// Limits of a result.
    fn limits(&self, clamp: Clamp) -> [i64; 2] {
        let most = 1 << (self.word_bits() - 1);
        match clamp {
            Clamp::Word => [-most, most - 1],
            Clamp::Positive => [1, most - 1],
            Clamp::Signal => [LEAST_SIGNAL, MOST_LEVEL],
            Clamp::Ambient => [1, MOST_LEVEL],
            Clamp::Chance => [1, MOST_CHANCE],
            Clamp::Window => [0, self.end()],
            Clamp::Growth | Clamp::Change => GROWTH,
        }
    }
}
