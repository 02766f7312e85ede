//! Sums over the bins of a fit: information and score of (mu, log S, log b), or how well the fit does.
//!
//! Mirrors `rtl_ref/likelihood_sums.v`. What a bin says goes on for nine beats of two cycles each, and four
//! multipliers work twice a beat: operands, product, and what is added to it take a cycle each. So does an adder for
//! each pair of sums: it adds to the one that stands second, and they change places. The last sum has one of its own.
//! What a bin adds to a sum goes there as soon as it is known. With `check` the residual's square goes over its
//! variance into a chi-square, in the place of the last sum; the others of such a pass are of no use.
//!
//! ```text
//! beat       k + 2                        k + 3   k + 4   k + 5         k + 7   k + 8
//! registers  weight, seen, unseen         once,   others  twice         tz, oz  tzz
//!                                         seen_z          (then mixed)
//! a check    square          variance     bits    (at 4)  over          twice   chi-square
//! ```

use crate::kernel::{Clocked, S, U};
use crate::signals;

use super::likelihood_estimator::params::Params;
use super::likelihood_estimator::pipeline::shift;
use super::likelihood_estimator::tables::{Tables, length};
use super::likelihood_estimator::words::{MOST_TERM, WEIGHT_FRACTION};
use super::likelihood_terms::{Expected, Residual, Share, Slope};

mod accumulation;
mod products;

/// A weight, 6 fraction bits.
pub type Weight = U<32>;
/// One count as weights have it.
const COUNT: i64 = 1 << WEIGHT_FRACTION;
/// A quarter of a count, which a variance has more.
const QUARTER: u64 = 16;

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
        #[size(ResidualBits)]
        pub residual: Residual,
        /// R lambda.
        #[size(ExpectedBits)]
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
        #[size(SlopeSumBits)]
        #[view(heading = "Likelihood", probe = true)]
        pub sum_11: S<48>,
        /// Sum of w s s z, 6 fraction bits.
        #[size(SlopeSumBits)]
        pub sum_12: S<48>,
        /// Sum of w s (1 - s) z.
        #[size(SlopeSumBits)]
        pub sum_13: S<48>,
        /// Sum of w s s.
        #[size(SumWordBits)]
        pub sum_22: S<43>,
        /// Sum of w s (1 - s).
        #[size(SumWordBits)]
        pub sum_23: S<43>,
        /// Sum of w (1 - s) (1 - s).
        #[size(SumWordBits)]
        pub sum_33: S<43>,
        /// Sum of v s z, 4 fraction bits.
        #[size(SlopeSumBits)]
        #[view(heading = "Likelihood", probe = true)]
        pub score_1: S<48>,
        /// Sum of v s.
        #[size(SumWordBits)]
        pub score_2: S<43>,
        /// Sum of v (1 - s).
        #[size(SumWordBits)]
        pub score_3: S<43>,
        /// Chi-square of a check, 8 fraction bits.
        #[size(ChiBits)]
        pub chi_square: U<35>,
        /// A bin is far from what the fit has.
        pub far: bool,
        /// The sums of each pair have changed places.
        changed: bool,
        /// Sum of w (1 - s) (1 - s), or in a check the chi-square.
        #[size(LastSumBits)]
        last_sum: S<44>,
        /// Operands of the first multiplier.
        #[size(ResidualBits)]
        first_a: Residual,
        /// Second operand of the first multiplier.
        first_b: S<14>,
        /// Their product.
        #[size(FirstProductBits)]
        first_product: S<47>,
        /// Operands of the second one.
        #[size(MixedBits)]
        second_a: S<33>,
        /// Second operand of the second multiplier.
        #[size(FactorBits)]
        second_b: S<26>,
        /// Their product.
        #[size(SecondProductBits)]
        second_product: S<59>,
        /// Operands of the third one.
        #[size(MixedBits)]
        third_a: S<33>,
        /// Second operand of the third multiplier.
        third_b: S<14>,
        /// Their product.
        #[size(ThirdProductBits)]
        third_product: S<47>,
        /// Operands of the fourth one.
        #[size(MixedBits)]
        fourth_a: S<33>,
        /// Second operand of the fourth multiplier.
        fourth_b: S<10>,
        /// Their product.
        #[size(FourthProductBits)]
        fourth_product: S<42>,
        /// w, one cycle ahead.
        #[size(WeightBits)]
        pub weight_first: Weight,
        /// v s, one cycle ahead.
        #[size(ResidualBits)]
        seen_first: Residual,
        /// The square of v, one cycle ahead.
        #[size(SquareBits)]
        square_first: U<48>,
        /// w.
        #[size(WeightBits)]
        weight: [Weight; 2],
        /// v s.
        #[size(ResidualBits)]
        seen: Residual,
        /// The square of v.
        #[size(SquareBits)]
        square: [U<48>; 3],
        /// v.
        #[size(ResidualBits)]
        residuals: Residual,
        /// v (1 - s).
        #[size(UnseenBits)]
        unseen: S<34>,
        /// s.
        shares: [Share; 3],
        /// z.
        z: [Slope; 6],
        /// A single bin.
        singles: [bool; 4],
        /// w s.
        #[size(WeightBits)]
        once: [Weight; 3],
        /// w (1 - s).
        #[size(MixedBits)]
        others: S<33>,
        /// v s z.
        #[size(SeenSlopeBits)]
        seen_z: S<42>,
        /// The residual's variance, with a quarter of a count more.
        #[size(VarianceBits)]
        variances: [U<33>; 2],
        /// Its bits.
        bits: U<6>,
        /// The residual's square after the longest shifts.
        #[size(SquareOverBits)]
        square_over: U<57>,
        /// The variance below its leading one.
        aligned: U<6>,
        /// The residual's square over its variance's leading one, 8 fraction bits.
        over: U<24>,
        /// The reciprocal of that variance's mantissa.
        reciprocal: U<10>,
        /// w s s, or a term of the chi-square, one cycle ahead.
        #[size(WeightBits)]
        twice_first: Weight,
        /// w s s.
        #[size(WeightBits)]
        twice: Weight,
        /// w s (1 - s).
        #[size(MixedBits)]
        mixed: S<33>,
        /// w s s z, one cycle ahead.
        #[size(WeightSlopeBits)]
        tz_first: S<41>,
        /// w s s z.
        #[size(WeightSlopeBits)]
        tz: S<41>,
        /// w s (1 - s) z.
        #[size(WeightSlopeBits)]
        oz: S<41>,
        /// w s s z z, or the largest square that is not far.
        #[size(WeightSlopeBits)]
        tzz: S<41>,
    }
}

impl Clocked for LikelihoodSums {
    type In = In;
    type Params = Params;

    fn next(&self, i: &In, p: &Params) -> Self {
        let mut d = *self;
        self.multiply(i, p, &mut d);
        if i.phase {
            self.carry(i, &mut d);
            self.subtract(&mut d);
        }
        self.compare(i, &mut d);
        self.accumulate(i, &mut d);
        if i.pass {
            d.clear(i.check);
            if p.has_second() {
                // What a check has left: no scan comes between it and the next fit.
                d.tzz = S::new(0);
            }
        }
        d
    }
}

impl LikelihoodSums {
    /// All that goes along.
    fn carry(&self, i: &In, d: &mut Self) {
        shift(&mut d.weight, self.weight_first);
        d.seen = self.seen_first;
        shift(&mut d.square, self.square_first);
        d.residuals = i.residual;
        shift(&mut d.shares, i.share);
        shift(&mut d.z, i.slope);
        shift(&mut d.singles, i.single);
        d.twice = self.twice_first;
    }

    /// Subtracts the part that is not due to the signal.
    fn subtract(&self, d: &mut Self) {
        let mixed = self.once[2].get() as i64 - self.twice.get() as i64;
        d.unseen = S::new(self.residuals.get() - self.seen_first.get());
        d.others = S::new(self.weight[1].get() as i64 - self.once[0].get() as i64);
        d.mixed = S::new(mixed);
    }

    /// The square over its variance, and whether it is far.
    fn compare(&self, i: &In, d: &mut Self) {
        let (long, short) = (self.bits.get() & 56, self.bits.get() & 7);
        let square = self.square[2].get();
        d.square_over = U::new((square << 9) >> long);
        let variance = self.variances[1].get() << 7 >> self.bits.get();
        d.aligned = U::new(variance & 63);
        if !i.phase {
            return;
        }
        shift(&mut d.variances, U::new(self.weight[0].get() + QUARTER));
        d.bits = U::new(length(self.variances[0].get() as i64).into());
        d.over = U::new((self.square_over.get() >> short).min(MOST_TERM as u64));
        d.reciprocal = U::new(Tables::reciprocal(self.aligned.get() as i64, 6) as u64);
        if i.check && self.singles[3] && square as i64 > self.tzz.get() {
            d.far = true;
        }
    }
}
