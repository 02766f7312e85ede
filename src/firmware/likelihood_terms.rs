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
use super::likelihood_estimator::pipeline::shift;
use super::likelihood_estimator::pulse::PulseWord;
use super::likelihood_estimator::tables::{Tables, length};
use super::likelihood_estimator::words::HAZARD_FRACTION;
use super::likelihood_memory::{Edge, Waiting, Width};

/// Bits of a hazard's mantissa.
const MANTISSA_BITS: u32 = 14;
/// Bits of the largest hazard.
const MOST_BITS: u64 = 26;
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
        #[size(ArrivalBits)]
        pub arrival: U<21>,
        /// S, 14 fraction bits [photons a shot].
        pub strength: U<24>,
        /// b, 30 fraction bits [1 / unit].
        pub ambient: U<24>,
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
        /// Part of the pulse before the word's end, half a beat early.
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
        sum: U<27>,
        /// The same within its limits.
        hazard: [Hazard; 5],
        /// Hazard of the signal.
        signal_hazard: [Hazard; 2],
        /// Bits of the hazard.
        bits: [U<5>; 5],
        /// The hazard's mantissa, half a beat early.
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
        /// Increase of k within a quarter, half a beat early, 22 fraction bits; then the share.
        grown: U<24>,
        /// k at the quarter before.
        k_before: K,
        /// k.
        k: K,
        /// k less lambda.
        gains: [U<13>; 3],
        /// s, half a beat early.
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
        /// n k and half of what is cut off it, half a beat early, 12 fraction bits.
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
            self.cut_out(i, &mut d);
            self.give(p, &mut d);
        }
        self.fetch(i, p, &mut d);
        self.light_up(i, &mut d);
        self.normalise(i, &mut d);
        self.divide(i, &mut d);
        self.multiply(i, &mut d);
        self.expect(i, p, &mut d);
        d
    }
}

impl LikelihoodTerms {
    /// The words of the pulse around the word's end, one in each cycle of a beat, and a straight line between them.
    fn fetch(&self, i: &In, p: &Params, d: &mut Self) {
        d.from_arrival = S::new(((i.word_end.get() as i64) << 3) - i.arrival.get() as i64);
        let time = self.from_arrival.get();
        let place = (time >> (p.step_log2 + 4)).clamp(-1024, 1022) + 1024;
        d.place = U::new(place as u64 + u64::from(!i.phase));
        let PulseWord { part, slope, first } = p.pulse[self.place.index()];
        d.fetched_part = U::new(part as u64);
        (d.fetched_slope, d.fetched_first) = (S::new(slope), S::new(first));
        if i.phase {
            shift(&mut d.sixteenths, U::new((time >> p.step_log2) as u64));
            shift(&mut d.low_part, self.fetched_part);
            shift(&mut d.low_slope, self.fetched_slope);
            shift(&mut d.low_first, self.fetched_first);
        }
        d.rise = self.fetched_part - self.low_part[0].get();
        d.risen = U::new(self.rise.get() * self.sixteenths[1].get());
        d.pulse_part = self.low_part[1] + (self.risen.get() >> 4);
        (d.pulse_slope, d.pulse_first) = (self.low_slope[1], self.low_first[1]);
    }

    /// Delays the values that accompany a bin.
    fn carry(&self, i: &In, p: &Params, d: &mut Self) {
        shift(&mut d.bin, i.word_bin);
        shift(&mut d.rest, i.word_rest);
        shift(&mut d.slides, i.word_slide);
        shift(&mut d.edge_alone, i.word_edge);
        shift(&mut d.first, i.word_first);
        shift(&mut d.ended, i.word_ended);
        shift(&mut d.waiting, i.word_waiting);
        shift(&mut d.width, i.word_width);
        let [waiting, ended] =
            [self.waiting[11], self.ended[11]].map(|shots| shots.get() & p.histogram.most_hits());
        let middle = if self.bin[11] { (2 * waiting).saturating_sub(ended) } else { 0 };
        shift(&mut d.middles, U::new(middle));
        let any = self.bin[11] || self.rest[11];
        shift(&mut d.awaited, any && self.waiting[11] != 0);
    }

    /// Cuts out the part that lies in the bin.
    fn cut_out(&self, i: &In, d: &mut Self) {
        let none = self.edge_alone[2] && self.first[2];
        d.last_part = if none { U::new(0) } else { self.pulse_part };
        d.last_slope = self.pulse_slope;
        let lit = self.bin[2] && !i.scan;
        d.part = if lit { self.pulse_part - self.last_part.get() } else { U::new(0) };
        let between = (self.pulse_slope.get() + self.last_slope.get()) >> 1;
        let z = if self.first[2] { self.pulse_first.get() } else { between };
        shift(&mut d.z, S::new(if self.rest[2] { 0 } else { z }));
    }

    /// The hazards: that of the signal begins in the first cycle of a beat, that of ambient light in the second.
    fn light_up(&self, i: &In, d: &mut Self) {
        (d.level, d.amount) = match i.phase {
            true => (i.ambient, U::new(2 * self.width[3].get())),
            false => (i.strength, self.part),
        };
        d.level_product = U::new(self.level.get() * self.amount.get());
        d.level_times = U::new(self.level_product.get() + 256);
        d.light = U::new((self.level_times.get() >> 9).min(MOST_HAZARD));
        d.lit_first = self.light;
        if i.phase {
            d.lit = self.lit_first;
            d.sum = U::new(self.lit_first.get() + self.light.get());
            shift(&mut d.hazard, U::new(self.sum.get().clamp(LEAST_HAZARD, MOST_HAZARD)));
            shift(&mut d.signal_hazard, self.lit);
        }
    }

    /// The sum's mantissa, in the first cycle of a beat; in the second the signal's part as it is shifted.
    fn normalise(&self, i: &In, d: &mut Self) {
        let bits = self.bits[0].get() as u32;
        let value = if i.phase { self.signal_hazard[1].get() } else { self.hazard[1].get() };
        let aligned = U::new(match bits.checked_sub(MANTISSA_BITS) {
            Some(excess) => value >> excess,
            None => value << (MANTISSA_BITS - bits),
        });
        d.mantissa_first = aligned;
        if i.phase {
            shift(&mut d.bits, U::new(length(self.hazard[0].get() as i64).into()));
            shift(&mut d.mantissa, self.mantissa_first);
            d.aligned = aligned;
        }
    }

    /// Computes the slope of k: it begins in the first cycle of a beat, and the share s in the second.
    fn divide(&self, i: &In, d: &mut Self) {
        let hazard = self.hazard[2].get() as i64;
        let mantissa = self.mantissa[0].get() as i64;
        let (few, many) = match i.phase {
            true => (Tables::reciprocal(mantissa, MANTISSA_BITS - 1), self.aligned.get() as i64),
            false => (hazard >> 10 & 1023, Tables::k_growth(hazard)),
        };
        (d.few, d.many, d.triple) =
            (U::new(few as u64), U::new(many as u64), U::new(3 * many as u64));
        let low = self.few.get() & 63;
        let (low, high) = (rows(low, self.many, self.triple), self.few.get() >> 6);
        d.begun = U::new(low);
        (d.few_left, d.many_left, d.triple_left) = (U::new(high), self.many, self.triple);
        let rest = rows(self.few_left.get(), self.many_left, self.triple_left);
        d.grown = U::new(self.begun.get() + (rest << 6));
        let bits = MANTISSA_BITS - 3;
        let rounded = (self.grown.get() >> bits) + (self.grown.get() >> (bits - 1) & 1);
        d.share_first = U::new(rounded.min(WHOLE));
        if i.phase {
            d.k_before = U::new(Tables::k_before(hazard) as u64);
            d.k = self.k_before + (self.grown.get() >> 10 & 2047);
            let lambda = self.hazard[4].get() >> 10;
            shift(&mut d.gains, U::new(self.k.get().wrapping_sub(lambda)));
            shift(&mut d.shares, self.share_first);
        }
    }

    /// Shots, those that end in the first cycle of a beat and those that wait in the second, and half of what is cut
    /// off each product.
    fn multiply(&self, i: &In, d: &mut Self) {
        (d.shots, d.factor) = match i.phase {
            true => (self.waiting[11], U::new(self.mantissa[2].get())),
            false => (self.ended[11], self.k),
        };
        d.shots_product = U::new(self.shots.get() * self.factor.get());
        d.half = U::new(match i.phase {
            true => 128,
            false => 23_u64.checked_sub(self.bits[4].get()).map_or(0, |bit| 1 << bit),
        });
        let times = self.shots_product.get() + self.half.get();
        d.ended_k_first = U::new(times);
        if i.phase {
            d.product = U::new(times);
            shift(&mut d.ended_k, self.ended_k_first);
        }
    }

    /// R lambda from its mantissa, and the residual.
    fn expect(&self, i: &In, p: &Params, d: &mut Self) {
        let (long, short) = (self.down.get() & 24, self.down.get() & 7);
        d.expected_first = U::new((self.product.get() << 2) >> long);
        d.surplus = S::new(self.ended_k[1].get() as i64 - self.product_shifted.get() as i64);
        if i.phase {
            d.down = U::new(MOST_BITS.wrapping_sub(self.bits[4].get()));
            let most = (1 << (p.histogram.count_bits + 18)) - 1;
            d.product_shifted = U::new((self.expected_first.get() >> short).min(most));
        }
    }

    /// Drives the outputs.
    fn give(&self, p: &Params, d: &mut Self) {
        let any = self.bin[14] || self.rest[14];
        let most = 1 << (p.histogram.count_bits + 8);
        let residual = (self.surplus.get() >> 8).clamp(-most, most - 1);
        d.residual = S::new(if any { residual } else { 0 });
        d.predicted = if any { self.product_shifted } else { U::new(0) };
        d.gain = self.gains[2];
        (d.share, d.slope) = (self.shares[2], self.z[11]);
        (d.middle, d.waits) = (self.middles[2], self.awaited[2]);
        (d.single, d.slide) = (self.bin[14], self.slides[14]);
    }
}

/// A product in rows, of two bits of the first factor each.
fn rows(few: u64, many: U<17>, triple: U<19>) -> u64 {
    let row = |two: u64| [0, many.get(), 2 * many.get(), triple.get()][two as usize & 3];
    (0..3).map(|place| row(few >> (2 * place)) << (2 * place)).sum()
}
