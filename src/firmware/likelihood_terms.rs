//! What a bin says of a point, in the likelihood estimator: residual, what is expected, and the signal's share.
//!
//! Mirrors `rtl_ref/likelihood_terms.v`. A bin goes on for sixteen beats of two cycles each; two
//! multipliers work twice a beat. What a beat comes to, from that of the word in the memory's register on:
//!
//! ```text
//! 0  time, place in the pulse   4  operands of light     8   length        12  operands of shots
//! 1  words around it            5  product, half         9   mantissa      13  product, half
//! 2  rise from one to the next  6  hazards of both       10  factor rows   14  shifts of R lambda
//! 3  part, z                    7  sum, limits           11  k, share      15  residual
//! ```

use crate::kernel::{Clocked, S, U};
use crate::signals;

use super::likelihood_estimator::params::Params;
use super::likelihood_memory::{Edge, Waiting, Width};

mod counts;
mod hazards;
mod pulse;

/// A hazard, 22 fraction bits.
pub type Hazard = U<26>;
/// Slope of a logarithm, 24 to 48 of which are one over a deviation of the pulse.
pub type Slope = S<9>;
/// The signal's share in a hazard, 12 fraction bits.
pub type Share = U<13>;
/// k(lambda), 12 fraction bits.
pub type K = U<17>;
/// An expected count, 12 fraction bits.
pub type Expected = U<42>;
/// n k - R lambda, 4 fraction bits.
pub type Residual = S<33, 4>;

signals! {
    /// Input ports.
    pub struct In {
        /// Second cycle of a beat.
        pub phase: bool,
        /// Without signal, unless the estimator knows of a cover glass, or looks for a second target.
        pub scan: bool,
        /// Without signal, if it does, or looks for a second target.
        #[only_if(MoreLight)]
        pub dark: bool,
        /// Arrival of the echo [units / 16].
        #[size(ArrivalBits)]
        pub arrival: U<21>,
        /// S, 14 fraction bits [photons a shot].
        pub strength: U<24>,
        /// b, 30 fraction bits [1 / unit].
        pub ambient: U<24>,
        /// Hazard of the cover glass's light, 22 fraction bits.
        #[only_if(Glass)]
        pub glass_light: Hazard,
        /// Hazard of the other echo's light, 22 fraction bits.
        #[only_if(HasSecond)]
        pub other_light: Hazard,
        /// The word is a bin.
        pub word_bin: bool,
        /// The word stands for all other bins.
        pub word_rest: bool,
        /// The word is an edge without a bin.
        pub word_edge: bool,
        /// A box goes on with it.
        pub word_slide: bool,
        /// Of bin 0.
        pub word_first: bool,
        /// Shots that end in it.
        #[size(RestBits)]
        pub word_ended: Waiting,
        /// Shots that wait when it begins.
        #[size(RestBits)]
        pub word_waiting: Waiting,
        /// Its width [units].
        #[size(WidthBits)]
        pub word_width: Width,
        /// End of the word [half units].
        #[size(EdgeBits)]
        pub word_end: Edge,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct LikelihoodTerms {
        /// v, 0 of what is no bin.
        #[size(ResidualBits)]
        #[view(heading = "Likelihood", curve = true, probe = true)]
        pub residual: Residual,
        /// R lambda.
        #[size(ExpectedBits)]
        #[view(heading = "Likelihood", curve = true, probe = true)]
        pub predicted: Expected,
        /// lambda / (exp(lambda) - 1), 12 fraction bits.
        pub gain: U<13>,
        /// s.
        #[view(probe = true)]
        pub share: Share,
        /// z.
        pub slope: Slope,
        /// Twice the shots that wait in the middle of a bin.
        #[size(MiddleBits)]
        pub middle: U<25>,
        /// Shots wait at it.
        pub waits: bool,
        /// The residual is that of a single bin.
        pub single: bool,
        /// A box goes on with it.
        pub slide: bool,
        /// Bits of the hazard.
        #[only_if(MoreLight)]
        pub hazard_bits: U<5>,
        /// Reciprocal of its mantissa, 10 fraction bits.
        #[only_if(MoreLight)]
        pub hazard_reciprocal: U<10>,
        /// Hazard of ambient light.
        #[only_if(HasSecond)]
        pub ambient_light: Hazard,
        /// Words on the way: of a bin, from the one at the pulse on.
        bin: [bool; 15],
        /// Of all others.
        rest: [bool; 15],
        /// With which a box goes on.
        slides: [bool; 15],
        /// Of an edge, and of bin 0.
        edge_alone: [bool; 3],
        /// Words of bin 0.
        first: [bool; 3],
        /// Shots that end.
        #[size(RestBits)]
        ended: [Waiting; 12],
        /// Shots that wait.
        #[size(RestBits)]
        waiting: [Waiting; 12],
        /// Width.
        #[size(WidthBits)]
        width: [Width; 4],
        /// Twice the shots that wait in the middle of a bin.
        #[size(MiddleBits)]
        middles: [U<25>; 3],
        /// Shots wait.
        awaited: [bool; 3],
        /// End of a word after the arrival [units / 16].
        #[size(ArrivalTimeBits)]
        from_arrival: S<22>,
        /// Place of a word of the pulse's ROM around that time: the one before it in the first cycle of a beat.
        place: U<11>,
        /// Part of the pulse before the time, from the pulse's ROM.
        fetched_part: U<17>,
        /// Slope.
        fetched_slope: Slope,
        /// Slope of that part.
        fetched_first: Slope,
        /// The same of the word before the time.
        low_part: [U<17>; 2],
        /// Slope of the word before the time.
        low_slope: [Slope; 2],
        /// Slope of the part of the word before the time.
        low_first: [Slope; 2],
        /// Distance of the time from the word before it [16ths].
        sixteenths: [U<4>; 2],
        /// Increase of the part from the one to the next, in the second cycle of a beat.
        rise: U<17>,
        /// Increase of the part to the time, in the first cycle of a beat [16ths].
        risen: U<21>,
        /// Part of the pulse before the word's end, one cycle ahead.
        pulse_part: U<17>,
        /// Slope there.
        pulse_slope: Slope,
        /// Slope of that part.
        pulse_first: Slope,
        /// The same at the end of the bin before.
        last_part: U<17>,
        /// Slope at the end of the bin before.
        last_slope: Slope,
        /// Part of the pulse in the bin.
        part: U<17>,
        /// z.
        z: [Slope; 12],
        /// S in the second cycle of a beat, b in the first.
        level: U<24>,
        /// Part of the light that is in the bin.
        amount: U<17>,
        /// Their product.
        level_product: U<41>,
        /// And half of what is cut off it.
        level_times: U<42>,
        /// Hazard of the signal in the first cycle of a beat, and in the second one of ambient light.
        light: Hazard,
        /// Hazard of the signal, in the second cycle.
        lit_first: Hazard,
        /// Hazard of the signal.
        lit: Hazard,
        /// Sum of both.
        #[size(HazardSumBits)]
        sum: U<28>,
        /// The same within its limits.
        hazard: [Hazard; 5],
        /// Hazard of the signal.
        signal_hazard: [Hazard; 2],
        /// Bits of the hazard.
        bits: [U<5>; 5],
        /// The hazard's mantissa, one cycle ahead.
        mantissa_first: U<14>,
        /// The hazard's mantissa.
        mantissa: [U<14>; 3],
        /// The signal's hazard, as it is shifted.
        aligned: U<14>,
        /// Factors of what k grows by in the second cycle of a beat, and of the share in the first.
        few: U<10>,
        /// The other one.
        many: U<17>,
        /// Three times that.
        triple: U<19>,
        /// Their product with the low six bits of the first.
        begun: U<23>,
        /// Its other bits.
        few_left: U<4>,
        /// The second, a cycle later.
        many_left: U<17>,
        /// Three times that.
        triple_left: U<19>,
        /// Increase of k within a quarter, one cycle ahead, 22 fraction bits; then the share.
        grown: U<24>,
        /// k at the quarter before.
        k_before: K,
        /// k.
        k: K,
        /// k less lambda.
        gains: [U<13>; 3],
        /// s, one cycle ahead.
        share_first: Share,
        /// s.
        shares: [Share; 3],
        /// Shots that end in the second cycle of a beat, and in the first those that wait.
        #[size(RestBits)]
        shots: Waiting,
        /// k, and the hazard's mantissa.
        factor: U<17>,
        /// Their product.
        #[size(EndedBits)]
        shots_product: U<51>,
        /// Half of what is cut off it.
        half: U<24>,
        /// n k and half of what is cut off it, one cycle ahead, 12 fraction bits.
        #[size(EndedBits)]
        ended_k_first: U<51>,
        /// n k and that half.
        #[size(EndedBits)]
        ended_k: [U<51>; 2],
        /// R times the mantissa, and half of what is cut off it.
        #[size(WaitingProductBits)]
        product: U<48>,
        /// By how many bits that is shifted.
        down: U<5>,
        /// Product after the longest shifts, by 16 and by 8.
        #[size(FirstShiftBits)]
        expected_first: U<50>,
        /// R lambda.
        #[size(ExpectedBits)]
        product_shifted: Expected,
        /// n k less R lambda.
        #[size(SurplusBits)]
        surplus: S<52>,
    }
}

impl Clocked for LikelihoodTerms {
    type In = In;
    type Params = Params;

    fn next(&self, i: &In, p: &Params) -> Self {
        let mut d = *self;
        if i.phase {
            self.carry(i, p, &mut d);
            self.cut_out(i, p, &mut d);
            self.give(p, &mut d);
        }
        self.fetch(i, p, &mut d);
        self.light_up(i, p, &mut d);
        self.normalise(i, &mut d);
        self.divide(i, &mut d);
        self.multiply(i, &mut d);
        self.expect(i, p, &mut d);
        d
    }
}
