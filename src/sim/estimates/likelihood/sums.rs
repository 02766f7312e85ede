//! Sums over the bins of a fit.

use crate::firmware::likelihood_estimator::words::{RESIDUAL_FRACTION, WEIGHT_FRACTION};

use super::number::Number;
use super::terms::Terms;

/// One count as weights have it.
const COUNT: i64 = 1 << WEIGHT_FRACTION;

/// Information of (mu, log S, log b), and the score.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums<N> {
    /// Information on mu.
    pub a11: N,
    /// On mu and log S.
    pub a12: N,
    /// On mu and log b.
    pub a13: N,
    /// On log S.
    pub a22: N,
    /// On log S and log b.
    pub a23: N,
    /// On log b.
    pub a33: N,
    /// Score of mu.
    pub y1: N,
    /// Of log S.
    pub y2: N,
    /// Of log b.
    pub y3: N,
}

impl<N: Number> Sums<N> {
    /// With a ridge of a quarter of a count for log b and of a 16th for the others.
    pub fn new(terms: &[(Terms<N>, N)]) -> Self {
        let [a11, a22, a33] = [COUNT >> 4 << 1, COUNT >> 4, COUNT >> 2].map(N::whole);
        let mut sums = Sums { a11, a22, a33, ..Sums::default() };
        for &(Terms { residual, weight, share, .. }, z) in terms {
            let of = |value: N| (value * share).shifted(12);
            let (once, seen) = (of(weight), of(residual));
            let twice = of(once);
            sums.a11 += (twice * z).floored(9) * z;
            sums.a12 += twice * z;
            sums.a13 += (once - twice) * z;
            sums.a22 += twice;
            sums.a23 += once - twice;
            sums.a33 += weight - once - once + twice;
            sums.y1 += seen * z;
            sums.y2 += seen;
            sums.y3 += residual - seen;
        }
        // mu counts in 32 of z, and residuals as weights do.
        let residual = i64::from(WEIGHT_FRACTION - RESIDUAL_FRACTION);
        Sums {
            a11: sums.a11.floored(1),
            a12: sums.a12.floored(5),
            a13: sums.a13.floored(5),
            y1: sums.y1.floored(5 - residual),
            y2: sums.y2.floored(-residual),
            y3: sums.y3.floored(-residual),
            ..sums
        }
    }
}
