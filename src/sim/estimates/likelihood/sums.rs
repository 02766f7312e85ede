//! Sums over the bins of a fit.

use crate::firmware::likelihood_estimator::words::{
    AMBIENT_RIDGE, RESIDUAL_FRACTION, RIDGE, WEIGHT_FRACTION,
};

use super::number::Number;
use super::terms::Terms;

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
    /// Information on the light from the cover glass, with mu, log S and log b, and alone; the score.
    pub glass: GlassSums<N>,
}

/// Information of (mu, log S, log b) with the logarithm of the cover glass's light, that light's own, and its score.
#[derive(Clone, Copy, Debug, Default)]
pub struct GlassSums<N> {
    /// Information on mu and log C.
    pub a14: N,
    /// On log S and log C.
    pub a24: N,
    /// On log b and log C.
    pub a34: N,
    /// On log C.
    pub a44: N,
    /// Score of log C.
    pub y4: N,
}

impl<N: Number> Sums<N> {
    /// Adds the terms up, from the ridges on.
    pub fn new(terms: &[(Terms<N>, N)], paired: bool) -> Self {
        let [a11, a22, a33] = [2 * RIDGE, RIDGE, AMBIENT_RIDGE].map(N::whole);
        let a44 = N::whole(RIDGE);
        let mut sums = Sums { a11, a22, a33, ..Sums::default() };
        let mut of_glass = GlassSums { a44, ..GlassSums::default() };
        for &(Terms { residual, weight, share, glass, still, .. }, z) in terms {
            let of = |value: N| (value * share).shifted(12);
            let (once, seen) = (of(weight), of(residual));
            let twice = of(once);
            sums.a11 += (twice * z).floored(9) * z;
            sums.a12 += twice * z;
            sums.a22 += twice;
            sums.y1 += seen * z;
            sums.y2 += seen;
            if paired {
                let of = |value: N, share: N| (value * share).shifted(12);
                let once = of(weight, still);
                let both = of(once, share);
                sums.a13 += both * z;
                sums.a23 += both;
                sums.a33 += of(once, still);
                sums.y3 += of(residual, still);
            } else {
                sums.a13 += (once - twice) * z;
                sums.a23 += once - twice;
                sums.a33 += weight - once - once + twice;
                sums.y3 += residual - seen;
            }
            if glass > N::default() {
                of_glass.add((residual, weight), (share, glass), z, paired.then_some(still));
            }
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
            glass: GlassSums {
                a14: of_glass.a14.floored(5),
                y4: of_glass.y4.floored(-residual),
                ..of_glass
            },
            ..sums
        }
    }
}

impl<N: Number> GlassSums<N> {
    /// Adds a bin with its residual and weight, the shares of echo and glass, and z.
    fn add(&mut self, (residual, weight): (N, N), (share, glass): (N, N), z: N, still: Option<N>) {
        let of = |value: N, share: N| (value * share).shifted(12);
        let once = of(weight, glass);
        let both = of(once, share);
        self.a14 += both * z;
        self.a24 += both;
        self.a34 += still.map_or(once - both, |still| of(once, still));
        self.a44 += of(once, glass);
        self.y4 += of(residual, glass);
    }
}
