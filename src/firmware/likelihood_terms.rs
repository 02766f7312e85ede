//! What a bin says of a point, in the likelihood estimator: residual, what is expected, and the signal's share.
//!
//! Mirrors `rtl_ref/likelihood_terms.v`. A bin goes through nine registers, a beat of two cycles each; two
//! multipliers work twice a beat.
//!
//! ```text
//! beat       k       k + 1      k + 2             k + 3    k + 4      k + 5     k + 6             k + 7      k + 8
//! registers  pulse   part, z    signal, ambient   hazard   mantissa   k, share  ended_k, product  expected   residual
//! ```

use crate::kernel::{Clocked, S, U};
use crate::signals;

use super::likelihood_estimator::params::Params;
use super::likelihood_estimator::pipeline::shift;
use super::likelihood_estimator::pulse::PulseWord;
use super::likelihood_estimator::tables::{Tables, length};
use super::likelihood_estimator::words::HAZARD_FRACTION;
use super::likelihood_memory::{Edge, Waiting, Width};

/// Bits of a hazard's mantissa.
const MANTISSA_BITS: u32 = 14;
/// Smallest and largest hazard: 2^-20 and just below 16.
const LEAST_HAZARD: u64 = 1 << (HAZARD_FRACTION - 20);
const MOST_HAZARD: u64 = (16 << HAZARD_FRACTION) - 1;
/// The whole of a hazard is signal: 12 fraction bits.
const WHOLE: u64 = 4096;

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
        /// Without signal.
        pub scan: bool,
        /// Arrival of the echo [units / 16].
        #[size("ArrivalBits")]
        pub arrival: U<21>,
        /// S, 14 fraction bits [photons a shot].
        pub strength: U<24>,
        /// b, 30 fraction bits [1 / unit].
        pub ambient: U<24>,
        /// The word is a bin.
        pub word_bin: bool,
        /// It stands for all other bins.
        pub word_rest: bool,
        /// It is an edge alone.
        pub word_edge: bool,
        /// A box goes on with it.
        pub word_slide: bool,
        /// Of bin 0.
        pub word_first: bool,
        /// Shots that end in it.
        #[size("RestBits")]
        pub word_ended: Waiting,
        /// Shots that wait when it begins.
        #[size("RestBits")]
        pub word_waiting: Waiting,
        /// Its width [units].
        #[size("WidthBits")]
        pub word_width: Width,
        /// Where it ends [half units].
        #[size("EdgeBits")]
        pub word_end: Edge,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct LikelihoodTerms {
        /// v, 0 of what is no bin.
        #[size("ResidualBits")]
        #[view(heading = "Likelihood", curve = true, probe = true)]
        pub residual: Residual,
        /// R lambda.
        #[size("ExpectedBits")]
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
        #[size("MiddleBits")]
        pub middle: U<35>,
        /// Shots wait at it.
        pub waits: bool,
        /// The residual is that of a single bin.
        pub single: bool,
        /// A box goes on with it.
        pub slide: bool,
        /// Words on the way: of a bin, from the one at the pulse on.
        bin: [bool; 8],
        /// Of all others.
        rest: [bool; 8],
        /// With which a box goes on.
        slides: [bool; 8],
        /// Of an edge, and of bin 0.
        edge_alone: bool,
        /// See there.
        first: bool,
        /// Shots that end.
        #[size("RestBits")]
        ended: [Waiting; 8],
        /// Shots that wait.
        #[size("RestBits")]
        waiting: [Waiting; 8],
        /// Width.
        #[size("WidthBits")]
        width: [Width; 2],
        /// A word of the pulse's ROM: part before.
        fetched_part: U<17>,
        /// Slope.
        fetched_slope: Slope,
        /// Slope of that part.
        fetched_first: Slope,
        /// The same of the word before the time.
        low_part: U<17>,
        /// See there.
        low_slope: Slope,
        /// See there.
        low_first: Slope,
        /// How far the time is from it to the next [16ths].
        sixteenths: U<4>,
        /// Part of the pulse before the word's end, half a beat early.
        pulse_part: U<17>,
        /// Slope there.
        pulse_slope: Slope,
        /// Slope of that part.
        pulse_first: Slope,
        /// The same at the end of the bin before.
        last_part: U<17>,
        /// See there.
        last_slope: Slope,
        /// Part of the pulse in the bin.
        part: U<17>,
        /// z.
        z: [Slope; 7],
        /// Hazard of the signal, half a beat early.
        lit_first: Hazard,
        /// Hazard of the signal.
        lit: Hazard,
        /// Hazard of ambient light.
        dim: Hazard,
        /// Sum of both, within its limits.
        hazard: [Hazard; 3],
        /// Hazard of the signal, at most that.
        signal_hazard: Hazard,
        /// Bits of the hazard.
        bits: [U<5>; 3],
        /// The hazard's mantissa.
        mantissa: [U<14>; 2],
        /// The signal's hazard, as it is shifted.
        aligned: U<14>,
        /// k.
        k: K,
        /// k less lambda.
        gains: [U<13>; 2],
        /// s.
        shares: [Share; 3],
        /// n k half a beat early, 12 fraction bits.
        #[size("EndedBits")]
        ended_k_first: U<51>,
        /// n k.
        #[size("EndedBits")]
        ended_k: [U<51>; 2],
        /// R times the mantissa.
        #[size("WaitingProductBits")]
        product: U<48>,
        /// R lambda.
        #[size("ExpectedBits")]
        product_shifted: Expected,
    }
}

impl Clocked for LikelihoodTerms {
    type In = In;
    type Params = Params;

    fn next(&self, i: &In, p: &Params) -> Self {
        let mut d = *self;
        if i.phase {
            self.carry(i, &mut d);
            self.cut_out(i, &mut d);
            self.add_up(&mut d);
            self.normalise(&mut d);
            self.divide(&mut d);
            self.expect(p, &mut d);
            self.give(p, &mut d);
        }
        self.fetch(i, p, &mut d);
        self.multiply(i, &mut d);
        d
    }
}

fn rounded(value: u64, bits: u32) -> u64 {
    (value >> bits) + (value >> (bits - 1) & 1)
}

impl LikelihoodTerms {
    /// The words of the pulse around the word's end, one in each cycle of a beat.
    fn fetch(&self, i: &In, p: &Params, d: &mut Self) {
        let time = ((i.word_end.get() as i64) << 3) - i.arrival.get() as i64;
        let place = (time >> (p.step_log2 + 4)).clamp(-1024, 1022) + 1024;
        let PulseWord { part, slope, first } = p.pulse[place as usize + usize::from(i.phase)];
        d.fetched_part = U::new(part as u64);
        (d.fetched_slope, d.fetched_first) = (S::new(slope), S::new(first));
        if i.phase {
            d.sixteenths = U::new((time >> p.step_log2) as u64);
            (d.low_part, d.low_slope) = (self.fetched_part, self.fetched_slope);
            d.low_first = self.fetched_first;
        } else {
            let growth = (self.fetched_part - self.low_part.get()).get() * self.sixteenths.get();
            d.pulse_part = self.low_part + (growth >> 4);
            (d.pulse_slope, d.pulse_first) = (self.low_slope, self.low_first);
        }
    }

    /// What goes along.
    fn carry(&self, i: &In, d: &mut Self) {
        shift(&mut d.bin, i.word_bin);
        shift(&mut d.rest, i.word_rest);
        shift(&mut d.slides, i.word_slide);
        (d.edge_alone, d.first) = (i.word_edge, i.word_first);
        shift(&mut d.ended, i.word_ended);
        shift(&mut d.waiting, i.word_waiting);
        shift(&mut d.width, i.word_width);
    }

    /// What of it is in the bin.
    fn cut_out(&self, i: &In, d: &mut Self) {
        let none = self.edge_alone && self.first;
        d.last_part = if none { U::new(0) } else { self.pulse_part };
        d.last_slope = self.pulse_slope;
        let lit = self.bin[0] && !i.scan;
        d.part = if lit { self.pulse_part - self.last_part.get() } else { U::new(0) };
        let between = (self.pulse_slope.get() + self.last_slope.get()) >> 1;
        let z = if self.first { self.pulse_first.get() } else { between };
        shift(&mut d.z, S::new(if self.rest[0] { 0 } else { z }));
    }

    /// The hazard.
    fn add_up(&self, d: &mut Self) {
        let sum = self.lit.get() + self.dim.get();
        shift(&mut d.hazard, U::new(sum.clamp(LEAST_HAZARD, MOST_HAZARD)));
        d.signal_hazard = U::new(self.lit.get().min(d.hazard[0].get()));
    }

    /// Its mantissa.
    fn normalise(&self, d: &mut Self) {
        let hazard = self.hazard[0].get();
        let bits = length(hazard as i64);
        let align = |value: u64| match bits.checked_sub(MANTISSA_BITS) {
            Some(excess) => value >> excess,
            None => value << (MANTISSA_BITS - bits),
        };
        shift(&mut d.bits, U::new(bits.into()));
        shift(&mut d.mantissa, U::new(align(hazard)));
        d.aligned = U::new(align(self.signal_hazard.get()));
    }

    /// k and s.
    fn divide(&self, d: &mut Self) {
        d.k = U::new(Tables::k(self.hazard[1].get() as i64) as u64);
        shift(&mut d.gains, U::new(self.k.get().saturating_sub(self.hazard[2].get() >> 10)));
        let mantissa = self.mantissa[0].get() as i64;
        let share = self.aligned.get() * Tables::reciprocal(mantissa, MANTISSA_BITS - 1) as u64;
        shift(&mut d.shares, U::new(rounded(share, MANTISSA_BITS - 3).min(WHOLE)));
    }

    /// R lambda from its mantissa.
    fn expect(&self, p: &Params, d: &mut Self) {
        let most = (1 << (p.histogram.count_bits + 18)) - 1;
        let predicted = match 24 - self.bits[2].get() as i64 {
            down @ 1.. => rounded(self.product.get(), down as u32),
            up => self.product.get() << -up,
        };
        d.product_shifted = U::new(predicted.min(most));
    }

    /// What comes out.
    fn give(&self, p: &Params, d: &mut Self) {
        let any = self.bin[7] || self.rest[7];
        let (ended_k, predicted) = (self.ended_k[1].get() as i64, self.product_shifted.get());
        let residual = ended_k - predicted as i64;
        let residual = (residual >> 8) + (residual >> 7 & 1);
        let most = 1 << (p.histogram.count_bits + 8);
        let residual = residual.clamp(-most, most - 1);
        d.residual = S::new(if any { residual } else { 0 });
        d.predicted = U::new(if any { predicted } else { 0 });
        d.gain = self.gains[1];
        (d.share, d.slope) = (self.shares[2], self.z[6]);
        let middle = (2 * self.waiting[7].get()).saturating_sub(self.ended[7].get());
        d.middle = U::new(if any { middle } else { 0 });
        d.waits = any && self.waiting[7] != 0;
        (d.single, d.slide) = (self.bin[7], self.slides[7]);
    }

    /// Products: in the first cycle of a beat those of signal and hits, in the second the others.
    fn multiply(&self, i: &In, d: &mut Self) {
        if i.phase {
            let dim = rounded(i.ambient.get() * self.width[1].get(), 8);
            d.dim = U::new(dim.min(MOST_HAZARD));
            d.product = U::new(self.waiting[5].get() * self.mantissa[1].get());
            d.lit = self.lit_first;
            shift(&mut d.ended_k, self.ended_k_first);
        } else {
            let lit = rounded(i.strength.get() * self.part.get(), 9);
            d.lit_first = U::new(lit.min(MOST_HAZARD));
            d.ended_k_first = U::new(self.ended[5].get() * self.k.get());
        }
    }
}
