//! Sums over the bins of a fit: information and score of (mu, log S, log b), or how well the fit does.
//!
//! Mirrors `rtl_ref/likelihood_sums.v`. What a bin says goes through five registers, a beat of two cycles each,
//! and four multipliers work twice a beat. With `check` the residual's square takes the place of the score, and
//! goes over its variance into a chi-square.
//!
//! ```text
//! beat       k              k + 1          k + 2    k + 3          k + 4
//! registers  weight, seen   once, seen_z   twice    tz, tzz, oz    the sums
//! ```

use crate::kernel::{Clocked, S, U};
use crate::signals;

use super::likelihood_estimator::params::Params;
use super::likelihood_estimator::pipeline::shift;
use super::likelihood_estimator::tables::{Tables, length};
use super::likelihood_estimator::words::WEIGHT_FRACTION;
use super::likelihood_terms::{Expected, Residual, Share, Slope};

/// A weight, 6 fraction bits.
pub type Weight = U<32>;
/// One count as weights have it.
const COUNT: i64 = 1 << WEIGHT_FRACTION;
/// A residual of so many squared deviations is no chance.
const FAR: u64 = 25;
/// A quarter of a count, which a variance has more.
const QUARTER: u64 = 16;
/// The part of a chi-square's term that is kept: 16 bits and its fraction.
const MOST_TERM: u64 = (1 << 24) - 1;

signals! {
    /// Input ports.
    pub struct In {
        /// Begins a pass.
        pub pass: bool,
        /// The pass is for the chi-square.
        pub check: bool,
        /// Second cycle of a beat.
        pub phase: bool,
        /// v, 0 of what is no bin.
        #[size("ResidualBits")]
        pub residual: Residual,
        /// R lambda.
        #[size("ExpectedBits")]
        pub predicted: Expected,
        /// lambda / (exp(lambda) - 1), 12 fraction bits.
        pub gain: U<13>,
        /// s.
        pub share: Share,
        /// z.
        pub slope: Slope,
        /// The residual is that of a single bin.
        pub single: bool,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct LikelihoodSums {
        /// Sum of w s s z z, 3 fraction bits less than weights.
        #[size("SquareSumBits")]
        #[view(heading = "Likelihood", probe = true)]
        pub sum_11: S<44>,
        /// Sum of w s s z, 6 fraction bits.
        #[size("SlopeSumBits")]
        pub sum_12: S<48>,
        /// Sum of w s (1 - s) z.
        #[size("SlopeSumBits")]
        pub sum_13: S<48>,
        /// Sum of w s s.
        #[size("SumWordBits")]
        pub sum_22: S<43>,
        /// Sum of w s (1 - s).
        #[size("SumWordBits")]
        pub sum_23: S<43>,
        /// Sum of w (1 - s) (1 - s).
        #[size("SumWordBits")]
        pub sum_33: S<43>,
        /// Sum of v s z, 4 fraction bits.
        #[size("SlopeSumBits")]
        #[view(heading = "Likelihood", probe = true)]
        pub score_1: S<48>,
        /// Sum of v s.
        #[size("SumWordBits")]
        pub score_2: S<43>,
        /// Sum of v (1 - s).
        #[size("SumWordBits")]
        pub score_3: S<43>,
        /// Chi-square, 8 fraction bits.
        #[size("ChiBits")]
        pub chi_square: U<35>,
        /// A bin is far from what the fit has.
        pub far: bool,
        /// w, half a beat early.
        #[size("WeightBits")]
        weight_first: Weight,
        /// v s, or the square of v, half a beat early.
        #[size("SeenBits")]
        seen_first: S<53>,
        /// w.
        #[size("WeightBits")]
        weight: [Weight; 4],
        /// v s.
        #[size("SeenBits")]
        seen: [S<53>; 4],
        /// v.
        #[size("ResidualBits")]
        residuals: [Residual; 4],
        /// s.
        shares: [Share; 2],
        /// z.
        z: [Slope; 3],
        /// A single bin.
        singles: bool,
        /// w s.
        #[size("WeightBits")]
        once: [Weight; 3],
        /// v s z.
        #[size("SeenSlopeBits")]
        seen_z: [S<42>; 3],
        /// The residual's square over its variance's leading one, 8 fraction bits.
        over: U<24>,
        /// The reciprocal of that variance's mantissa.
        reciprocal: U<10>,
        /// w s s, or a term of the chi-square, half a beat early.
        #[size("WeightBits")]
        twice_first: Weight,
        /// w s s.
        #[size("WeightBits")]
        twice: [Weight; 2],
        /// w s s z, half a beat early.
        #[size("WeightSlopeBits")]
        tz_first: S<41>,
        /// w s s z.
        #[size("WeightSlopeBits")]
        tz: S<41>,
        /// w s s z z.
        #[size("WeightSlopeBits")]
        tzz: S<41>,
        /// w s (1 - s) z.
        #[size("WeightSlopeBits")]
        oz: S<41>,
    }
}

impl Clocked for LikelihoodSums {
    type In = In;
    type Params = Params;

    fn next(&self, i: &In, p: &Params) -> Self {
        let mut d = *self;
        self.first_products(i, p, &mut d);
        if i.phase {
            self.second_products(i, &mut d);
            self.carry(i, &mut d);
            self.compare(i, &mut d);
            self.accumulate(i, &mut d);
        }
        if i.pass {
            d.clear();
        }
        d
    }
}

/// A product over 2^bits, half rounded up.
fn rounded(value: i64, bits: u32) -> i64 {
    (value >> bits) + (value >> (bits - 1) & 1)
}

impl LikelihoodSums {
    /// Sums begin with a ridge of a count for log b, and of a 16th of one for the others.
    fn clear(&mut self) {
        self.sum_11 = S::new(COUNT >> 4 << 1);
        (self.sum_12, self.sum_13) = (S::new(0), S::new(0));
        (self.sum_22, self.sum_23, self.sum_33) = (S::new(COUNT >> 4), S::new(0), S::new(COUNT));
        (self.score_1, self.score_2, self.score_3) = (S::new(0), S::new(0), S::new(0));
        (self.chi_square, self.far) = (U::new(0), false);
    }

    /// Products of the first cycle of a beat.
    fn first_products(&self, i: &In, p: &Params, d: &mut Self) {
        if i.phase {
            return;
        }
        let predicted = (i.predicted.get() >> 5).min((1 << (p.histogram.count_bits + 8)) - 1);
        d.weight_first = U::new(rounded((predicted * i.gain.get()) as i64, 13) as u64);
        let most = (1 << (p.histogram.count_bits + 1)) - 1;
        let near = i.residual.get().clamp(-most, most);
        d.seen_first = S::new(match i.check {
            true => (near * near) >> 2,
            false => rounded(i.residual.get() * i.share.get() as i64, 12),
        });
        let twice = match i.check {
            true => (self.over.get() * self.reciprocal.get()) >> 10,
            false => rounded((self.once[0].get() * self.shares[1].get()) as i64, 12) as u64,
        };
        d.twice_first = U::new(twice);
        d.tz_first = S::new(self.twice[0].get() as i64 * self.z[2].get());
    }

    /// Products of the second cycle.
    fn second_products(&self, i: &In, d: &mut Self) {
        let once = rounded((self.weight[0].get() * self.shares[0].get()) as i64, 12);
        shift(&mut d.once, U::new(once as u64));
        let seen = if i.check { 0 } else { self.seen[0].get() };
        shift(&mut d.seen_z, S::new(seen * self.z[0].get()));
        let (twice, z) = (self.twice[0].get() as i64, self.z[2].get());
        d.oz = S::new((self.once[1].get() as i64 - twice) * z);
        d.tzz = S::new((self.tz_first.get() >> 9) * z);
        d.tz = self.tz_first;
    }

    /// All that goes along.
    fn carry(&self, i: &In, d: &mut Self) {
        shift(&mut d.weight, self.weight_first);
        shift(&mut d.seen, self.seen_first);
        shift(&mut d.residuals, i.residual);
        shift(&mut d.shares, i.share);
        shift(&mut d.z, i.slope);
        d.singles = i.single;
        shift(&mut d.twice, self.twice_first);
    }

    /// The square over its variance, and whether it is far.
    fn compare(&self, i: &In, d: &mut Self) {
        let weight = self.weight[0].get();
        let square = if i.check { self.seen[0].get() as u64 } else { 0 };
        let variance = weight + QUARTER;
        let bits = length(variance as i64);
        let over = match bits.checked_sub(9) {
            Some(down) => square >> down,
            None => square << (9 - bits),
        };
        let aligned = if bits > 7 { variance >> (bits - 7) } else { variance << (7 - bits) };
        d.over = U::new(over.min(MOST_TERM));
        d.reciprocal = U::new(Tables::reciprocal(aligned as i64, 6) as u64);
        if self.singles && square > FAR * (weight + COUNT as u64) {
            d.far = true;
        }
    }

    /// Adds a bin.
    fn accumulate(&self, i: &In, d: &mut Self) {
        if i.check {
            d.chi_square = self.chi_square + self.twice[1].get();
            return;
        }
        let word = |words: &[Weight]| words[words.len() - 1].get() as i64;
        let (weight, once, twice) = (word(&self.weight), word(&self.once), word(&self.twice));
        let (residual, seen) = (self.residuals[3].get(), self.seen[3].get());
        d.sum_11 = self.sum_11 + self.tzz.get();
        d.sum_12 = self.sum_12 + self.tz.get();
        d.sum_13 = self.sum_13 + self.oz.get();
        d.sum_22 = self.sum_22 + twice;
        d.sum_23 = self.sum_23 + (once - twice);
        d.sum_33 = self.sum_33 + (weight - 2 * once + twice);
        d.score_1 = self.score_1 + self.seen_z[2].get();
        d.score_2 = self.score_2 + seen;
        d.score_3 = self.score_3 + (residual - seen);
    }
}
