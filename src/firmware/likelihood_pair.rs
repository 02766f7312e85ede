//! Another echo beside the one that is fitted, in the likelihood estimator: its light, the share r of what counts as
//! ambient light then, which is neither of both, and the sums of a fit that log b has with that share.
//!
//! Mirrors `rtl_ref/likelihood_pair.v`. The pulse is that of `likelihood_terms` at another arrival. Four multipliers
//! work twice a beat of two cycles, but for the last. Beats count from that of a word in the memory's register on, as in
//! `likelihood_terms`:
//!
//! ```text
//! beat       0     1      2     3     4      5        6            11       14      16 (terms)  17    19    20    21
//! registers  time  words  rise  part  level  product  other_light  aligned  shares  product     seen  once  both  square, both_z
//! ```

use crate::kernel::{Clocked, S, U};
use crate::signals;

use super::likelihood_estimator::params::Params;
use super::likelihood_estimator::pipeline::shift;
use super::likelihood_estimator::words::{AMBIENT_RIDGE, MOST_HAZARD, WHOLE};
use super::likelihood_memory::Edge;
use super::likelihood_sums::Weight;
use super::likelihood_terms::{Hazard, Residual, Share, Slope};

mod products;
mod pulse;

/// Bits of a hazard's mantissa.
const MANTISSA_BITS: u64 = 14;
/// Half of what is cut off a hazard.
const HALF_HAZARD: u64 = 1 << 8;
/// Bits that are cut off a share.
const SHARE_CUT: u64 = 11;

signals! {
    /// Input ports.
    pub struct In {
        /// Begins the sums of a pass.
        pub pass: bool,
        /// Second cycle of a beat.
        pub phase: bool,
        /// The other echo has light.
        pub paired: bool,
        /// Its arrival [units / 16].
        #[size(ArrivalBits)]
        pub other_arrival: U<21>,
        /// Its S, 14 fraction bits [photons a shot].
        pub other_strength: U<24>,
        /// The word is a bin.
        pub word_bin: bool,
        /// The word is an edge without a bin.
        pub word_edge: bool,
        /// Of bin 0.
        pub word_first: bool,
        /// End of the word [half units].
        #[size(EdgeBits)]
        pub word_end: Edge,
        /// Hazard of the cover glass's light, 22 fraction bits.
        #[only_if(Glass)]
        pub glass_light: Hazard,
        /// Hazard of ambient light, in the beat after that of `glass_light`.
        pub ambient_light: Hazard,
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
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct LikelihoodPair {
        /// Hazard of the other echo's light in the second cycle of a beat, 22 fraction bits.
        pub other_light: Hazard,
        /// r, as `likelihood_glass` needs it.
        pub still_share: Share,
        /// Sum of w s r z, 6 fraction bits.
        #[size(SlopeSumBits)]
        pub still_13: S<48>,
        /// Sum of w s r.
        #[size(SumWordBits)]
        pub still_23: S<43>,
        /// Sum of w r r.
        #[size(SumWordBits)]
        pub still_33: S<43>,
        /// Sum of v r, 4 fraction bits.
        #[size(SumWordBits)]
        pub still_score: S<43>,
        /// Words on the way: of a bin.
        bin: [bool; 3],
        /// Of an edge.
        edge_alone: [bool; 3],
        /// Words of bin 0.
        first: [bool; 3],
        /// End of a word after the arrival [units / 16].
        #[size(ArrivalTimeBits)]
        from_arrival: S<22>,
        /// Place of a word of the pulse's ROM around that time: the one before it in the first cycle of a beat.
        place: U<11>,
        /// Part of the pulse before the time, from the pulse's ROM.
        fetched_part: U<17>,
        /// The same of the word before the time.
        low_part: [U<17>; 2],
        /// Distance of the time from the word before it [16ths].
        sixteenths: [U<4>; 2],
        /// Increase of the part from the one to the next, in the second cycle of a beat.
        rise: U<17>,
        /// Increase of the part to the time, in the first cycle of a beat [16ths].
        risen: U<21>,
        /// Part of the pulse before the word's end, one cycle ahead.
        pulse_part: U<17>,
        /// The same at the end of the bin before.
        last_part: U<17>,
        /// Part of the pulse in the bin.
        part: U<17>,
        /// S in the first cycle of a beat, a hazard as it is shifted in the second.
        level: U<24>,
        /// Part of the light, or the reciprocal.
        amount: U<17>,
        /// Their product.
        level_product: U<41>,
        /// The product and half of what is cut off it.
        level_times: U<42>,
        /// Hazard of the other echo, one cycle ahead.
        lit: Hazard,
        /// Hazard of the cover glass's light in the beat before.
        #[only_if(Glass)]
        last_glass: Hazard,
        /// Hazards of ambient light and of the cover glass's together, on the way.
        still_light: [Hazard; 3],
        /// The hazard, shifted as the bin's mantissa is.
        aligned: U<14>,
        /// r, one cycle ahead.
        share_first: Share,
        /// r.
        shares: [Share; 5],
        /// s.
        echo_shares: [Share; 3],
        /// z.
        z: [Slope; 4],
        /// Residual, or w.
        #[size(MixedBits)]
        first_a: S<33>,
        /// r.
        first_b: S<14>,
        /// Their product.
        #[size(ThirdProductBits)]
        first_product: S<47>,
        /// v r.
        #[size(ResidualBits)]
        seen: Residual,
        /// w r.
        #[size(WeightBits)]
        once: Weight,
        /// w r.
        #[size(WeightBits)]
        second_a: Weight,
        /// Share of it: s, or r.
        second_b: S<14>,
        /// Their product.
        #[size(ThirdProductBits)]
        second_product: S<47>,
        /// w s r.
        #[size(WeightBits)]
        both: Weight,
        /// w r r.
        #[size(WeightBits)]
        square: Weight,
        /// w s r and z.
        #[size(WeightBits)]
        third_a: Weight,
        /// Second operand of the last multiplier.
        third_b: Slope,
        /// Their product.
        #[size(WeightSlopeBits)]
        third_product: S<41>,
        /// w s r z.
        #[size(WeightSlopeBits)]
        both_z: S<41>,
    }
}

impl Clocked for LikelihoodPair {
    type In = In;
    type Params = Params;

    fn next(&self, i: &In, p: &Params) -> Self {
        let mut d = *self;
        self.fetch(i, p, &mut d);
        self.light_up(i, &mut d);
        self.divide(i, &mut d);
        self.multiply(i, p, &mut d);
        if i.phase {
            self.cut_out(i, &mut d);
            d.last_glass = i.glass_light;
            let still = (i.ambient_light.get() + self.last_glass.get()).min(MOST_HAZARD as u64);
            shift(&mut d.still_light, U::new(still));
            shift(&mut d.shares, self.share_first);
            d.still_share = self.shares[4];
            shift(&mut d.echo_shares, i.share);
            shift(&mut d.z, i.slope);
            self.accumulate(&mut d);
        }
        if i.pass {
            d.clear();
        }
        d
    }
}

impl LikelihoodPair {
    /// The hazard of the other echo, begun in the first cycle of a beat.
    fn light_up(&self, i: &In, d: &mut Self) {
        (d.level, d.amount) = match i.phase {
            true => (U::new(self.aligned.get()), U::new(i.hazard_reciprocal.get())),
            false => (if i.paired { i.other_strength } else { U::new(0) }, self.part),
        };
        d.level_product = U::new(self.level.get() * self.amount.get());
        let half = if i.phase { 1 << (SHARE_CUT - 1) } else { HALF_HAZARD };
        d.level_times = U::new(self.level_product.get() + half);
        d.lit = U::new((self.level_times.get() >> 9).min(MOST_HAZARD as u64));
        d.other_light = self.lit;
    }

    /// The share of the hazard, begun in the second cycle of a beat.
    fn divide(&self, i: &In, d: &mut Self) {
        if i.phase {
            let (bits, hazard) = (i.hazard_bits.get(), self.still_light[2].get());
            d.aligned = U::new(match bits.checked_sub(MANTISSA_BITS) {
                Some(excess) => hazard >> excess,
                None => hazard << (MANTISSA_BITS - bits),
            });
        }
        d.share_first = U::new((self.level_times.get() >> SHARE_CUT).min(WHOLE as u64));
    }

    /// Adds a bin to the sums.
    fn accumulate(&self, d: &mut Self) {
        d.still_score = self.still_score + self.seen.get();
        d.still_23 = self.still_23 + self.both.get() as i64;
        d.still_33 = self.still_33 + self.square.get() as i64;
        d.still_13 = self.still_13 + self.both_z.get();
    }

    /// Sets the sums to their ridges.
    fn clear(&mut self) {
        (self.still_13, self.still_23) = (S::new(0), S::new(0));
        (self.still_33, self.still_score) = (S::new(AMBIENT_RIDGE), S::new(0));
    }
}
