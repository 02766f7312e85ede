//! Cover glass in the likelihood estimator: the hazard of its light, its share of a bin's hazard, and the sums of a
//! fit that the logarithm of this light (log C) adds.
//!
//! Mirrors `rtl_ref/likelihood_glass.v`. Four multipliers work twice a beat of two cycles, but for the last. Beats count
//! from that of a word in the memory's register on, as in `likelihood_terms`:
//!
//! ```text
//! beat       4      5        6            11      12       14      16 (terms)  17    19    20    21
//! registers  level  product  glass_light  aligned product  shares  product     seen  once  both  square, both_z
//! ```

use crate::kernel::{Clocked, S, U, wrapped};
use crate::signals;

use super::likelihood_estimator::params::Params;
use super::likelihood_estimator::pipeline::shift;
use super::likelihood_estimator::words::{MOST_HAZARD, RIDGE, WHOLE};
use super::likelihood_sums::Weight;
use super::likelihood_terms::{Hazard, Residual, Share, Slope};

/// Bits of a hazard's mantissa.
const MANTISSA_BITS: u64 = 14;
/// Half of what is cut off a hazard.
const HALF_HAZARD: u64 = 1 << 8;
/// Bits that are cut off a share.
const SHARE_CUT: u64 = 11;
/// Half of the 12 bits that are cut off a product.
const HALF: i64 = 1 << 11;

signals! {
    /// Input ports.
    pub struct In {
        /// Begins the sums of a pass.
        pub pass: bool,
        /// Second cycle of a beat.
        pub phase: bool,
        /// C, 14 fraction bits [photons a shot].
        pub glass: U<24>,
        /// Part of the glass's light in a bin, 17 fraction bits.
        pub word_glass: U<17>,
        /// Bits of the bin's hazard.
        pub hazard_bits: U<5>,
        /// Reciprocal of the hazard's mantissa, 10 fraction bits.
        pub hazard_reciprocal: U<10>,
        /// v, 0 of what is no bin.
        #[size(ResidualBits)]
        pub residual: Residual,
        /// w, in the second cycle of the beat after `residual`.
        #[size(WeightBits)]
        pub weight_first: Weight,
        /// s.
        pub share: Share,
        /// z.
        pub slope: Slope,
        /// Another echo has light: what counts as ambient light has a share of its own.
        #[only_if(HasSecond)]
        pub paired: bool,
        /// That share.
        #[only_if(HasSecond)]
        pub still_share: Share,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct LikelihoodGlass {
        /// Hazard of the glass's light in the second cycle of a beat, 22 fraction bits.
        pub glass_light: Hazard,
        /// Sum of w s g z, with g the glass's share; 6 fraction bits.
        #[size(SlopeSumBits)]
        pub sum_14: S<48>,
        /// Sum of w s g.
        #[size(SumWordBits)]
        pub sum_24: S<43>,
        /// Sum of w (1 - s) g.
        #[size(SumWordBits)]
        pub sum_34: S<43>,
        /// Sum of w g g.
        #[size(SumWordBits)]
        pub sum_44: S<43>,
        /// Sum of v g, 4 fraction bits.
        #[size(SumWordBits)]
        pub score_4: S<43>,
        /// Parts of the light on the way.
        parts: [U<17>; 4],
        /// C in the first cycle of a beat, the glass's hazard as it is shifted in the second.
        level: U<24>,
        /// Part of the light, or the reciprocal.
        amount: U<17>,
        /// Their product.
        level_product: U<41>,
        /// The product and half of what is cut off it.
        level_times: U<42>,
        /// Hazard, one cycle ahead.
        light: Hazard,
        /// Hazards on the way.
        hazards: [Hazard; 4],
        /// The hazard, shifted as the bin's mantissa is.
        aligned: U<14>,
        /// g, one cycle ahead.
        share_first: Share,
        /// g.
        shares: [Share; 6],
        /// s.
        echo_shares: [Share; 3],
        /// z.
        z: [Slope; 4],
        /// Residual, or w.
        #[size(MixedBits)]
        first_a: S<33>,
        /// g.
        first_b: S<14>,
        /// Their product.
        #[size(ThirdProductBits)]
        first_product: S<47>,
        /// v g.
        #[size(ResidualBits)]
        seen: Residual,
        /// w g.
        #[size(WeightBits)]
        once: [Weight; 2],
        /// w g.
        #[size(WeightBits)]
        second_a: Weight,
        /// Share of it: s, or g.
        second_b: S<14>,
        /// Their product.
        #[size(ThirdProductBits)]
        second_product: S<47>,
        /// w s g.
        #[size(WeightBits)]
        both: Weight,
        /// w g g.
        #[size(WeightBits)]
        square: Weight,
        /// w s g and z.
        #[size(WeightBits)]
        third_a: Weight,
        /// Second operand of the last multiplier.
        #[size(GlassFactorBits)]
        third_b: S<14>,
        /// Their product.
        #[size(GlassProductBits)]
        third_product: S<46>,
        /// w s g z.
        #[size(WeightSlopeBits)]
        both_z: S<41>,
        /// w g r, with r the share of what counts as ambient light beside another echo.
        #[only_if(HasSecond)]
        #[size(WeightBits)]
        still: Weight,
    }
}

impl Clocked for LikelihoodGlass {
    type In = In;
    type Params = Params;

    fn next(&self, i: &In, p: &Params) -> Self {
        let mut d = *self;
        self.light_up(i, &mut d);
        self.divide(i, &mut d);
        self.multiply(i, p, &mut d);
        if i.phase {
            shift(&mut d.parts, i.word_glass);
            shift(&mut d.hazards, self.glass_light);
            shift(&mut d.shares, self.share_first);
            shift(&mut d.echo_shares, i.share);
            shift(&mut d.z, i.slope);
            self.accumulate(i, &mut d);
        }
        if i.pass {
            d.clear();
        }
        d
    }
}

impl LikelihoodGlass {
    /// The hazard of the light, begun in the first cycle of a beat.
    fn light_up(&self, i: &In, d: &mut Self) {
        (d.level, d.amount) = match i.phase {
            true => (U::new(self.aligned.get()), U::new(i.hazard_reciprocal.get())),
            false => (i.glass, self.parts[3]),
        };
        d.level_product = U::new(self.level.get() * self.amount.get());
        let half = if i.phase { 1 << (SHARE_CUT - 1) } else { HALF_HAZARD };
        d.level_times = U::new(self.level_product.get() + half);
        d.light = U::new((self.level_times.get() >> 9).min(MOST_HAZARD as u64));
        d.glass_light = self.light;
    }

    /// The share of the hazard, begun in the second cycle of a beat.
    fn divide(&self, i: &In, d: &mut Self) {
        if i.phase {
            let (bits, hazard) = (i.hazard_bits.get(), self.hazards[3].get());
            d.aligned = U::new(match bits.checked_sub(MANTISSA_BITS) {
                Some(excess) => hazard >> excess,
                None => hazard << (MANTISSA_BITS - bits),
            });
        }
        d.share_first = U::new((self.level_times.get() >> SHARE_CUT).min(WHOLE as u64));
    }

    /// The products of residual, weight and shares.
    fn multiply(&self, i: &In, p: &Params, d: &mut Self) {
        let weight_bits = p.weight_bits();
        let weight = |value: i64| U::new((value >> 12) as u64 & ((1 << weight_bits) - 1));
        (d.first_a, d.first_b) = match i.phase {
            true => (S::new(i.weight_first.get() as i64), S::new(self.shares[3].get() as i64)),
            false => (S::new(i.residual.get()), S::new(self.shares[2].get() as i64)),
        };
        d.first_product = S::new(self.first_a.get() * self.first_b.get());
        let first = self.first_product.get() + HALF;
        let second_b = if i.phase { self.shares[5] } else { self.echo_shares[2] };
        (d.second_a, d.second_b) = (self.once[0], S::new(second_b.get() as i64));
        d.second_product = S::new(self.second_a.get() as i64 * self.second_b.get());
        let second = self.second_product.get() + HALF;
        if i.phase {
            shift(&mut d.once, weight(first));
            d.square = weight(second);
            (d.third_a, d.third_b) = (self.both, S::new(self.z[3].get()));
            d.both_z = S::new(wrapped(self.third_product.get(), weight_bits + 9));
            if p.has_second() {
                d.third_product = S::new(self.third_a.get() as i64 * self.third_b.get());
            }
        } else {
            d.seen = S::new(wrapped(first >> 12, p.histogram.count_bits + 9));
            d.both = weight(second);
            let product = self.third_a.get() as i64 * self.third_b.get();
            let bits = weight_bits + if p.has_second() { 14 } else { 9 };
            d.third_product = S::new(wrapped(product, bits));
            if p.has_second() {
                (d.third_a, d.third_b) = (self.once[0], S::new(i.still_share.get() as i64));
                d.still = weight(self.third_product.get() + HALF);
            }
        }
    }

    /// Adds a bin to the sums.
    fn accumulate(&self, i: &In, d: &mut Self) {
        let [both, once] = [self.both, self.once[1]].map(|weight| weight.get() as i64);
        d.score_4 = self.score_4 + self.seen.get();
        d.sum_24 = self.sum_24 + both;
        let still = if i.paired { self.still.get() as i64 } else { once - both };
        d.sum_34 = self.sum_34 + still;
        d.sum_44 = self.sum_44 + self.square.get() as i64;
        d.sum_14 = self.sum_14 + self.both_z.get();
    }

    /// Sets the sums to their ridges.
    fn clear(&mut self) {
        (self.sum_14, self.sum_24, self.sum_34) = (S::new(0), S::new(0), S::new(0));
        (self.sum_44, self.score_4) = (S::new(RIDGE), S::new(0));
    }
}
