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

use crate::kernel::{Clocked, S, U, wrapped};
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
/// Half of the 12 bits that are cut off a product, to round it.
const HALF: i64 = 1 << 11;
/// A residual of so many squared deviations is no chance.
const FAR: i64 = 25;
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
        /// w, half a beat early.
        #[size(WeightBits)]
        weight_first: Weight,
        /// v s, half a beat early.
        #[size(ResidualBits)]
        seen_first: Residual,
        /// The square of v, half a beat early.
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
        /// w s s, or a term of the chi-square, half a beat early.
        #[size(WeightBits)]
        twice_first: Weight,
        /// w s s.
        #[size(WeightBits)]
        twice: Weight,
        /// w s (1 - s).
        #[size(MixedBits)]
        mixed: S<33>,
        /// w s s z, half a beat early.
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
        }
        d
    }
}

impl LikelihoodSums {
    /// Sums begin with a ridge of a count for log b, and of a 16th of one for the others.
    fn clear(&mut self, check: bool) {
        self.last_sum = S::new(if check { 0 } else { COUNT });
        self.sum_11 = S::new(COUNT >> 4 << 1);
        (self.sum_12, self.sum_13) = (S::new(0), S::new(0));
        (self.sum_22, self.sum_23) = (S::new(COUNT >> 4), S::new(0));
        (self.score_1, self.score_2, self.score_3) = (S::new(0), S::new(0), S::new(0));
        (self.far, self.changed) = (false, false);
        // What is on the way from a pass that was no check is no square.
        (self.square, self.reciprocal, self.twice_first) = Default::default();
    }

    /// Registers the four products. Their destination in the first cycle of a beat is kept for the second.
    fn multiply(&self, i: &In, p: &Params, d: &mut Self) {
        self.front_operands(i, p, d);
        self.back_operands(i, d);
        d.first_product = S::new(self.first_a.get() * self.first_b.get());
        d.second_product = S::new(self.second_a.get() * self.second_b.get());
        d.third_product = S::new(self.third_a.get() * self.third_b.get());
        d.fourth_product = S::new(self.fourth_a.get() * self.fourth_b.get());

        let first = self.first_product.get() + if i.phase { 0 } else { 2 * HALF };
        let second = self.second_product.get() + if i.check && !i.phase { 0 } else { HALF };
        let third = self.third_product.get() + if i.check || i.phase { 0 } else { HALF };
        let fourth = self.fourth_product.get() + if i.check { FAR * COUNT } else { 0 };
        let (count_bits, weight_bits) = (p.histogram.count_bits, p.weight_bits());
        let weight = |value: i64| U::new(value as u64 & ((1 << weight_bits) - 1));
        let slope = |value: i64| S::new(wrapped(value, weight_bits + 9));
        d.weight_first = weight(first >> 13);
        d.square_first = U::new((second >> 2) as u64 & ((1 << (2 * count_bits)) - 1));
        d.seen_first = S::new(wrapped(second >> 12, count_bits + 9));
        (d.twice_first, d.tz_first) = (weight(third >> 12), slope(fourth));
        if i.phase {
            shift(&mut d.once, weight(second >> 12));
            d.seen_z = S::new(wrapped(first, count_bits + 18));
            (d.oz, d.tzz, d.tz) = (slope(third), slope(fourth), self.tz_first);
        }
    }

    /// A weight, then a share of the residual times its slope; a share of the residual or its square, then a share
    /// of the weight.
    fn front_operands(&self, i: &In, p: &Params, d: &mut Self) {
        if i.phase {
            (d.first_a, d.first_b) = (self.seen_first, S::new(self.z[0].get()));
            d.second_a = S::new(self.weight_first.get() as i64);
            d.second_b = S::new(self.shares[0].get() as i64);
            return;
        }
        let predicted = (i.predicted.get() >> 5).min((1 << (p.histogram.count_bits + 8)) - 1);
        (d.first_a, d.first_b) = (S::new(predicted as i64), S::new(i.gain.get() as i64));
        let most = (1 << (p.histogram.count_bits + 1)) - 1;
        let near = i.residual.get().clamp(-most, most);
        d.second_a = S::new(if i.check { near } else { i.residual.get() });
        d.second_b = S::new(if i.check { near } else { i.share.get() as i64 });
    }

    /// A share of that share or a term of the chi-square, then the other share times its slope; a share of the share
    /// times its slope, and times it again, or how far a square may be.
    fn back_operands(&self, i: &In, d: &mut Self) {
        let (twice, [.., z_4, z_5]) = (self.twice.get() as i64, self.z.map(|z| z.get()));
        let (third_a, third_b) = match (i.phase, i.check) {
            (true, _) => (self.once[2].get() as i64 - twice, z_4),
            (_, true) => (self.over.get() as i64, (self.reciprocal.get() << 2) as i64),
            _ => (self.once[0].get() as i64, self.shares[2].get() as i64),
        };
        let (fourth_a, fourth_b) = match (i.phase, i.check) {
            (_, true) => (self.weight[0].get() as i64, FAR),
            (true, _) => (self.tz_first.get() >> 9, z_5),
            _ => (twice, z_4),
        };
        (d.third_a, d.third_b) = (S::new(third_a), S::new(third_b));
        (d.fourth_a, d.fourth_b) = (S::new(fourth_a), S::new(fourth_b));
    }

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
        d.over = U::new((self.square_over.get() >> short).min(MOST_TERM));
        d.reciprocal = U::new(Tables::reciprocal(self.aligned.get() as i64, 6) as u64);
        if i.check && self.singles[3] && square as i64 > self.tzz.get() {
            d.far = true;
        }
    }

    /// Adds a bin.
    fn accumulate(&self, i: &In, d: &mut Self) {
        d.sum_33 = S::new(self.last_sum.get());
        if i.check {
            d.chi_square = U::new(self.last_sum.get() as u64);
        }
        d.changed = i.phase;
        if i.phase || self.changed {
            let added = |second: i64, first: i64| if i.phase { second } else { first };
            d.sum_12 = self.sum_13 + added(self.oz.get(), self.tz.get());
            d.score_1 = self.sum_11 + added(self.tzz.get(), self.seen_z.get());
            d.sum_22 = self.sum_23 + added(self.mixed.get(), self.twice.get() as i64);
            d.score_2 = self.score_3 + added(self.unseen.get(), self.seen.get());
            // Of the last one w (1 - s) comes first, and then w s (1 - s) leaves it.
            d.last_sum = self.last_sum
                + match (i.check, i.phase) {
                    (true, _) => added(self.twice.get() as i64, 0),
                    (false, true) => self.others.get(),
                    (false, false) => -self.mixed.get(),
                };
            (d.sum_13, d.sum_11) = (self.sum_12, self.score_1);
            (d.sum_23, d.score_3) = (self.sum_22, self.score_2);
        }
    }
}
