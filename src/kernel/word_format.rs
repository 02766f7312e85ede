//! Two's complement words whose width and point are values, with one rounding.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A two's complement word: how wide, and where its point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WordFormat {
    /// Width [bits].
    pub width: u32,
    /// Fraction bits; may exceed the width.
    pub fraction: u32,
}

/// Treatment of a value that the word cannot hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overflow {
    /// Take the nearest value it can hold.
    Saturate,
    /// Give none.
    Refuse,
}

/// The low bits of `value`, sign-extended: what a register of so many, 1 to 64, keeps.
#[inline(always)]
pub const fn wrapped(value: i64, bits: u32) -> i64 {
    let surplus = i64::BITS - bits;
    value << surplus >> surplus
}

impl WordFormat {
    /// Smallest integer of the word.
    pub const fn min(self) -> i64 {
        -(1 << (self.width - 1))
    }

    /// Largest integer of the word.
    pub const fn max(self) -> i64 {
        (1 << (self.width - 1)) - 1
    }

    /// Magnitude that its values stay below.
    pub fn range(self) -> f64 {
        (f64::from(self.width) - 1.0 - f64::from(self.fraction)).exp2()
    }

    /// Returns the weight of the last bit.
    pub fn lsb(self) -> f64 {
        (-f64::from(self.fraction)).exp2()
    }

    /// The integer that stands for `value`, halves rounded away from zero. There is none for what
    /// is not a number.
    pub fn round(self, value: f64, overflow: Overflow) -> Option<i64> {
        let scaled = value * (1u64 << self.fraction) as f64;
        let nearest = (!scaled.is_nan()).then(|| scaled.round() as i64)?;
        match overflow {
            Overflow::Saturate => Some(nearest.clamp(self.min(), self.max())),
            Overflow::Refuse => (self.min()..=self.max()).contains(&nearest).then_some(nearest),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const W1: WordFormat = WordFormat { width: 16, fraction: 23 };
    const B2: WordFormat = WordFormat { width: 16, fraction: 17 };

    #[test]
    fn halves_round_away_from_zero() {
        let ulp = (-23f64).exp2();
        let round = |value| W1.round(value, Overflow::Refuse);
        assert_eq!(round(2.5 * ulp), Some(3));
        assert_eq!(round(-2.5 * ulp), Some(-3));
        assert_eq!(round(2.4999 * ulp), Some(2));
        assert_eq!(round(-0.4999 * ulp), Some(0));
    }

    #[test]
    fn what_does_not_fit_saturates_or_is_refused() {
        let over = (-8f64).exp2();
        assert_eq!(W1.round(over, Overflow::Refuse), None);
        assert_eq!(W1.round(over, Overflow::Saturate), Some(32767));
        assert_eq!(W1.round(-over, Overflow::Refuse), Some(-32768));
        assert_eq!(B2.round(f64::NEG_INFINITY, Overflow::Saturate), Some(-32768));
        assert_eq!(B2.round(1e300, Overflow::Saturate), Some(32767));
        assert_eq!(B2.round(f64::NAN, Overflow::Saturate), None);
    }

    #[test]
    fn a_register_keeps_its_low_bits_with_the_sign() {
        assert_eq!(wrapped((1 << 35) + 3, 36), 3 - (1 << 35));
        assert_eq!((wrapped(-1, 64), wrapped(9, 4)), (-1, -7));
    }
}
