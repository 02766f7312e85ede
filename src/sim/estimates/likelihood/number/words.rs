//! Integers as the firmware's words have them.

use crate::firmware::likelihood_estimator::tables::{self, Tables};
use crate::firmware::likelihood_estimator::words::{HAZARD_FRACTION, MOST_TERM, WHOLE};
use crate::kernel::wrapped;

use super::Number;

/// Bits of a hazard's mantissa.
const MANTISSA_BITS: i64 = 14;
/// Fraction bits of a chance.
const CHANCE_FRACTION: i64 = 24;

impl Number for i64 {
    const LEAST: Self = 1;

    fn whole(value: i64) -> Self {
        value
    }

    fn constant(word: i64, _: f64) -> Self {
        word
    }

    fn value(self, fraction: u32) -> f64 {
        self as f64 * (-f64::from(fraction)).exp2()
    }

    fn place(self) -> usize {
        self as usize
    }

    fn shifted(self, bits: i64) -> Self {
        match bits {
            ..=0 => self << -bits,
            63.. => 0,
            _ => (self >> bits) + (self >> (bits - 1) & 1),
        }
    }

    fn floored(self, bits: i64) -> Self {
        if bits < 0 { self << -bits } else { self >> bits }
    }

    fn times(self, other: Self) -> Self {
        self.wrapping_mul(other)
    }

    fn less(self, a: Self, b: Self) -> Self {
        self.wrapping_sub(a.wrapping_mul(b))
    }

    fn kept(self, bits: u32) -> Self {
        let most = 1 << (bits - 1);
        self.clamp(-most, most - 1)
    }

    fn filled(self, bits: u32) -> Self {
        self.min((1 << bits) - 1)
    }

    fn wrapped(self, bits: u32) -> Self {
        wrapped(self, bits)
    }

    fn reciprocal(self) -> (Self, i64) {
        let (mantissa, bits) = tables::reciprocal(self);
        (mantissa, bits.into())
    }

    /// Rounded down, as the root comes digit by digit.
    fn root(self) -> Self {
        self.isqrt()
    }

    fn bits(magnitudes: &[Self]) -> u32 {
        tables::length(magnitudes.iter().fold(0, |all, magnitude| all | magnitude))
    }

    fn log2_64(self) -> Self {
        tables::log2_64(self)
    }

    /// As far as its third power.
    fn hazard(chance: Self) -> Self {
        let square = (chance * chance).shifted(CHANCE_FRACTION);
        let cube = (square * chance).shifted(CHANCE_FRACTION);
        chance + square.shifted(1) + (cube * 341).shifted(10)
    }

    fn k(hazard: Self) -> Self {
        Tables::k(hazard)
    }

    fn share(signal: Self, hazard: Self) -> Self {
        let excess = excess(hazard);
        let (mantissa, signal) = (hazard.floored(excess), signal.floored(excess));
        let share = signal * Tables::reciprocal(mantissa, MANTISSA_BITS as u32 - 1);
        share.shifted(MANTISSA_BITS - 1 + 10 - 12).min(WHOLE)
    }

    fn expected(shots: Self, hazard: Self) -> Self {
        let excess = excess(hazard);
        let mantissa = hazard.floored(excess);
        (shots * mantissa).shifted(i64::from(HAZARD_FRACTION) - 12 - excess)
    }

    /// Over the variance's leading one, then over its mantissa.
    fn over(square: Self, variance: Self) -> Self {
        let bits = i64::from(tables::length(variance));
        let reciprocal = Tables::reciprocal(variance.floored(bits - 7), 6);
        (square.floored(bits - 9).min(MOST_TERM) * reciprocal) >> 10
    }
}

/// By how many bits a hazard is shifted so that its leading one is the mantissa's.
fn excess(hazard: i64) -> i64 {
    i64::from(tables::length(hazard)) - MANTISSA_BITS
}
