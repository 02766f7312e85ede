//! Terms of a bin at a point: its residual, its weight, and the signal's share of its hazard.

use crate::firmware::likelihood_estimator::tables::{Tables, length};
use crate::firmware::likelihood_estimator::words::{HAZARD_FRACTION, RESIDUAL_FRACTION};

use super::arithmetic::{clamped, shifted};

/// Smallest and largest hazard: 2^-20 and just below 16.
const LEAST_HAZARD: i64 = 1 << (HAZARD_FRACTION - 20);
const MOST_HAZARD: i64 = (16 << HAZARD_FRACTION) - 1;
/// Bits of a hazard's mantissa.
const MANTISSA_BITS: i64 = 14;
/// Fraction bits of k and of an expected count.
const FRACTION: i64 = 12;
/// The whole of a hazard is signal: 12 fraction bits.
pub const WHOLE: i64 = 4096;

/// A bin, or all bins outside of the fit as one.
#[derive(Clone, Copy, Debug)]
pub struct Bin {
    /// Shots that end in it.
    pub ended: i64,
    /// Shots that wait when it begins.
    pub waiting: i64,
    /// Hazard of the signal [1, 22 fraction bits].
    pub signal: i64,
    /// Hazard of ambient light.
    pub ambient: i64,
}

/// Terms of a bin.
#[derive(Clone, Copy, Debug, Default)]
pub struct Terms {
    /// Expected count R lambda, 12 fraction bits.
    pub expected: i64,
    /// v, 4 fraction bits.
    pub residual: i64,
    /// w, 6 fraction bits.
    pub weight: i64,
    /// s, 12 fraction bits.
    pub share: i64,
}

impl Bin {
    /// With words for counts of so many bits.
    pub fn terms(&self, count_bits: u32) -> Terms {
        let hazard = (self.signal + self.ambient).clamp(LEAST_HAZARD, MOST_HAZARD);
        let signal = self.signal.min(hazard);
        // Both are shifted so that the hazard's leading one is the mantissa's.
        let excess = i64::from(length(hazard)) - MANTISSA_BITS;
        let align = |value: i64| if excess > 0 { value >> excess } else { value << -excess };
        let (mantissa, signal) = (align(hazard), align(signal));
        let share = signal * Tables::reciprocal(mantissa, MANTISSA_BITS as u32 - 1);
        let share = shifted(share, MANTISSA_BITS - 1 + 10 - FRACTION).min(WHOLE);
        let most_expected = (1 << (count_bits + 18)) - 1;
        let expected =
            shifted(self.waiting * mantissa, i64::from(HAZARD_FRACTION) - FRACTION - excess);
        let expected = expected.min(most_expected);
        let k = Tables::k(hazard);
        let residual = shifted(self.ended * k - expected, FRACTION - i64::from(RESIDUAL_FRACTION));
        let gain = (k - (hazard >> 10)).max(0);
        let weight = shifted((expected >> 5).min((1 << (count_bits + 8)) - 1) * gain, 13);
        Terms { expected, residual: clamped(residual, count_bits + 9), weight, share }
    }
}
