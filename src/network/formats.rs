//! The number formats of the estimator (thesis Table 6.4) as types, with one rounding.

use fixed::types::extra::{U13, U14, U15, U17, U23, U29};
use fixed::{FixedI16, FixedI32, FixedI64};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::weights::Weights;

/// W1: 16 bits, 23 of them fraction, so below 2^-8. Carried in 32 bits, because a `fixed` type
/// has no more fraction bits than bits; [`W1`] has the range.
pub type HiddenWeight = FixedI32<U23>;
/// B1: 16 bits, 13 fraction.
pub type HiddenBias = FixedI16<U13>;
/// W2: 16 bits, 14 fraction [m].
pub type OutputWeight = FixedI16<U14>;
/// B2: 16 bits, 17 fraction, so below 1/4 [m]. Carried in 32 bits; [`B2`] has the range.
pub type OutputBias = FixedI32<U17>;
/// Output of a hidden neuron: 16 bits, 15 fraction.
pub type Activation = FixedI16<U15>;
/// Sum of a hidden neuron: 36 bits, 23 fraction; carried in 64.
pub type L1In = FixedI64<U23>;
/// Depth: 36 bits, 29 fraction; carried in 64 [m].
pub type Depth = FixedI64<U29>;

/// A network's weights as the ROMs hold them.
pub type Fixed = Weights<HiddenWeight, HiddenBias, OutputWeight, OutputBias>;

/// A two's complement word: how wide, and where its point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WordFormat {
    /// Width [bits].
    pub width: u32,
    /// Fraction bits; may exceed the width.
    pub fraction: u32,
}

/// Format of [`HiddenWeight`].
pub const W1: WordFormat = WordFormat { width: 16, fraction: 23 };
/// Format of [`HiddenBias`].
pub const B1: WordFormat = WordFormat { width: 16, fraction: 13 };
/// Format of [`OutputWeight`].
pub const W2: WordFormat = WordFormat { width: 16, fraction: 14 };
/// Format of [`OutputBias`].
pub const B2: WordFormat = WordFormat { width: 16, fraction: 17 };
/// Format of [`Activation`].
pub const L1_OUT: WordFormat = WordFormat { width: 16, fraction: 15 };

/// Sums past this magnitude share the last entries of the activation table.
pub const TANSIG_RANGE: i64 = 4;

/// What to do with a value that the word cannot hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overflow {
    /// Take the nearest value it can hold.
    Saturate,
    /// Give none.
    Refuse,
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
}
