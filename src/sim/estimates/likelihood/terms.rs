//! Terms of a bin at a point: its residual, its weight, and the signal's share of its hazard.

use crate::firmware::likelihood_estimator::words::{LEAST_HAZARD, MOST_HAZARD, RESIDUAL_FRACTION};

use super::number::Number;

/// Fraction bits of k and of an expected count.
const FRACTION: i64 = 12;

/// A bin, or all bins outside of the fit as one.
#[derive(Clone, Copy, Debug)]
pub struct Bin<N> {
    /// Shots that end in it.
    pub ended: N,
    /// Shots that wait when it begins.
    pub waiting: N,
    /// Hazard of the signal [1, 22 fraction bits].
    pub signal: N,
    /// Hazard of ambient light.
    pub ambient: N,
    /// Hazard of the cover glass's light.
    pub glass: N,
    /// Hazard of the other echo's light.
    pub other: N,
}

/// Terms of a bin.
#[derive(Clone, Copy, Debug, Default)]
pub struct Terms<N> {
    /// Expected count R lambda, 12 fraction bits.
    pub expected: N,
    /// v, 4 fraction bits.
    pub residual: N,
    /// w, 6 fraction bits.
    pub weight: N,
    /// s, 12 fraction bits.
    pub share: N,
    /// The share of the cover glass's light, 12 fraction bits.
    pub glass: N,
    /// The share of ambient light and of the cover glass's, 12 fraction bits.
    pub still: N,
}

impl<N: Number> Bin<N> {
    /// With words for counts of so many bits.
    pub fn terms(&self, count_bits: u32) -> Terms<N> {
        let hazard = self.signal + self.ambient + self.glass + self.other;
        let hazard = hazard.within([LEAST_HAZARD, MOST_HAZARD].map(N::whole));
        let none = N::default();
        let share =
            |part: N| if part > none { N::share(part.at_most(hazard), hazard) } else { none };
        let [share, glass, still] = [self.signal, self.glass, self.ambient + self.glass].map(share);
        let expected = N::expected(self.waiting, hazard).filled(count_bits + 18);
        let k = N::k(hazard);
        let surplus = self.ended * k - expected;
        let residual = surplus.shifted(FRACTION - i64::from(RESIDUAL_FRACTION));
        let gain = (k - hazard.floored(10)).at_least(N::default());
        let weight = (expected.floored(5).filled(count_bits + 8) * gain).shifted(13);
        Terms { expected, residual: residual.kept(count_bits + 9), weight, share, glass, still }
    }
}

impl<N: Number> Terms<N> {
    /// The residual's square, 6 fraction bits as weights have.
    pub fn squared(&self, count_bits: u32) -> N {
        let residual = self.residual.abs().filled(count_bits + 1);
        (residual * residual).floored(2)
    }

    /// The residual's square over its variance, a quarter of a count more; 8 fraction bits.
    pub fn chi_square(&self, count_bits: u32) -> N {
        N::over(self.squared(count_bits), self.weight + N::whole(16))
    }
}
