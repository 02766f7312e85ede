//! Where a box stands highest above ambient light, in the likelihood estimator, and how much of that there is.
//!
//! Mirrors `rtl_ref/likelihood_scan.v`. In a scan a box slides over the bins. The memory keeps what entered it
//! until it leaves. One unit takes logarithms: of a box's excess in the first cycle of a beat and of what is
//! expected in the second, and in a load those of a block of bins.
//!
//! ```text
//! beat       k           k + 1               k + 2     k + 3   k + 4
//! registers  entering    excess, expected    logs      score   best
//! ```
//!
//! Of eight blocks, as far as they have a 64th of the first one's exposure, the one at 3/8 of the order of hazards
//! is kept: it is among the lowest three.

use crate::kernel::module::{Module, Visitor};
use crate::kernel::{S, U};
use crate::signals;

use super::histogram_builder::{Count, MOST_BINS};
use super::likelihood_estimator::params::Params;
use super::likelihood_estimator::pipeline::shift;
use super::likelihood_estimator::tables::{LOG2, length};
use super::likelihood_memory::{Exposure, Place, Waiting};
use super::likelihood_terms::{Expected, Residual};

/// Score of a box in which less than expected ended.
const NONE: i64 = -4096;
/// What is added to the expected count of a bin at which shots wait, 8 fraction bits: a tenth.
const ADDED: i64 = 26;
/// A block counts with a 64th of the first one's exposure.
const LEAST_EXPOSURE: i64 = 6 * 64;

/// 64 times a logarithm to base 2, or a sum of such.
pub type Log = S<14>;
/// Counts above what is expected, 8 fraction bits.
pub type Excess = S<48, 8>;

signals! {
    /// Input ports.
    pub struct In {
        /// Begins a load.
        pub load: bool,
        /// A block of bins is complete.
        pub block_done: bool,
        /// Hits of the block.
        #[size("RestBits")]
        pub block_ended: Waiting,
        /// Its exposure [shots units].
        #[size("ExposureBits")]
        pub block_exposure: Exposure,
        /// Begins a pass.
        pub pass: bool,
        /// It is a scan.
        pub scan: bool,
        /// Second cycle of a beat.
        pub phase: bool,
        /// A bin of a scan, or a beat after the last one, comes.
        pub slide: bool,
        /// n k - R lambda, 0 of what is no bin.
        #[size("ResidualBits")]
        pub residual: Residual,
        /// R lambda.
        #[size("ExpectedBits")]
        pub predicted: Expected,
        /// Twice the shots that wait in the middle of the bin.
        #[size("MiddleBits")]
        pub middle: U<35>,
        /// Shots wait at it.
        pub waits: bool,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Registers {
        /// 64 log2 of the squared excess of the highest box over what is expected in it.
        #[view(heading = "Likelihood", probe = true)]
        pub best_score: Log,
        /// Its excess.
        #[size("ExcessBits")]
        #[view(heading = "Likelihood", probe = true)]
        pub best_excess: Excess,
        /// Twice the shots that wait in the middle of a bin, over its bins.
        #[size("BoxMiddleBits")]
        pub best_middle: U<45>,
        /// Bins in it.
        #[size("PlaceBits")]
        pub box_length: Place,
        /// Its first bin and the one after its last, together.
        #[size("BoxSumBits")]
        pub box_sum: U<12>,
        /// Hits of the block that shows the ambient light.
        #[size("CountBits")]
        pub ambient_ended: Count,
        /// Its exposure [shots units].
        #[size("ExposureBits")]
        pub ambient_exposure: Exposure,
        /// It is the only one.
        pub lone: bool,
        /// Bins that have come.
        #[size("PlaceBits")]
        count: Place,
        /// A bin has come.
        entered: bool,
        /// Its excess.
        #[size("ExcessBits")]
        entering_excess: Excess,
        /// What is expected in it, 8 fraction bits.
        #[size("BoxExpectedBits")]
        entering_expected: U<48>,
        /// Twice the shots that wait in its middle.
        #[size("MiddleBits")]
        entering_middle: U<35>,
        /// What leaves the box: its excess.
        #[size("ExcessBits")]
        leaving_excess: Excess,
        /// Expected.
        #[size("BoxExpectedBits")]
        leaving_expected: U<48>,
        /// Twice the shots that wait.
        #[size("MiddleBits")]
        leaving_middle: U<35>,
        /// Excess of the box, and as it goes along.
        #[size("ExcessBits")]
        excess: [Excess; 3],
        /// Expected in the box.
        #[size("BoxExpectedBits")]
        box_expected: U<48>,
        /// Twice the shots that wait, and as they go along.
        #[size("BoxMiddleBits")]
        box_middle: [U<45>; 3],
        /// The box is within the histogram.
        boxed: [bool; 3],
        /// Its middle.
        #[size("PlaceBits")]
        place: [Place; 3],
        /// Bits of the number whose logarithm is taken.
        log_bits: U<6>,
        /// The six bits after its leading one.
        log_part: U<6>,
        /// Logarithm of an excess or of hits.
        upper_log: Log,
        /// Logarithm of what is expected or of an exposure.
        lower_log: Log,
        /// Score of the box.
        score: Log,
        /// Middle of the highest box.
        #[size("PlaceBits")]
        best_place: Place,
        /// Exposure of the block.
        #[size("ExposureBits")]
        held_exposure: Exposure,
        /// A block is in the logarithms.
        block: [bool; 3],
        /// Blocks that have come.
        block_count: U<3>,
        /// Blocks whose hazards are known.
        judged: U<3>,
        /// Blocks that have enough exposure.
        exposed: U<4>,
        /// Logarithm that an exposure has to be above.
        threshold: Log,
        /// Logarithms of the lowest hazards, in order.
        lowest: [Log; 3],
        /// Their blocks.
        which: [U<3>; 3],
    }
}

/// What enters and leaves a box.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Kept {
    excess: Excess,
    predicted: U<48>,
    middle: U<35>,
}

/// Registers and memories.
#[derive(Clone, Debug, PartialEq)]
pub struct LikelihoodScan {
    /// Registers.
    pub registers: Registers,
    /// Bins that entered, without reset.
    kept: Box<[Kept; MOST_BINS]>,
    /// Hits and exposures of the blocks, without reset.
    blocks: [(Waiting, Exposure); 8],
}

impl Default for LikelihoodScan {
    fn default() -> Self {
        LikelihoodScan {
            registers: Registers::default(),
            kept: Box::new([Kept::default(); MOST_BINS]),
            blocks: Default::default(),
        }
    }
}

impl Module for LikelihoodScan {
    const COUNT: usize = <Registers as Module>::COUNT;

    #[inline(always)]
    fn visit(&self, then: Option<&mut Self>, visitor: &mut impl Visitor) {
        visitor.signals("registers", &self.registers, then.map(|then| &mut then.registers));
    }
}

impl LikelihoodScan {
    /// The rising edge of `clk_sys`.
    pub fn rise(&mut self, i: &In, p: &Params) {
        let (q, d) = (self.registers, self.next(i, p));
        if i.block_done {
            self.blocks[q.block_count.index()] = (i.block_ended, i.block_exposure);
        }
        if i.phase && q.entered {
            self.kept[q.count.index().wrapping_sub(1) % p.histogram.bins] = Kept {
                excess: q.entering_excess,
                predicted: q.entering_expected,
                middle: q.entering_middle,
            };
        }
        self.registers = d;
    }

    /// Whether no edge changes anything until an input does.
    pub fn rests(&self, i: &In, p: &Params) -> bool {
        !i.block_done && !i.phase && self.next(i, p) == self.registers
    }

    fn next(&self, i: &In, p: &Params) -> Registers {
        let q = self.registers;
        let mut d = q;
        q.log(i, &mut d);
        q.blocks(i, &mut d);
        let pick = (q.exposed.get().wrapping_sub(1) & 15) * 3 / 8;
        let block = self.blocks[q.which[(pick as usize).min(2)].index()];
        let most = p.histogram.most_hits();
        (d.ambient_ended, d.ambient_exposure) = (U::new(block.0.get().min(most)), block.1);
        d.lone = q.exposed == 1;
        if i.phase {
            let bins = p.histogram.bins;
            let leaving = q.count.index().wrapping_sub(p.box_bins);
            q.enter(i, p, &self.kept[leaving % bins], &mut d);
            q.slide(p, &mut d);
            q.judge(&mut d);
        }
        let half = p.box_bins as u64 / 2;
        let from = q.best_place.get().saturating_sub(half);
        let until = (q.best_place.get() + p.box_bins as u64 - half).min(p.histogram.bins as u64);
        (d.box_length, d.box_sum) = (U::new(until - from), U::new(from + until));
        if i.pass && i.scan {
            d.begin();
        }
        d
    }
}

impl Registers {
    /// Begins a scan.
    fn begin(&mut self) {
        (self.count, self.entered) = (U::new(0), false);
        self.boxed = [false; 3];
        (self.excess[0], self.box_expected, self.box_middle[0]) = Default::default();
        self.best_score = S::new(i64::from(i16::MIN) / 4);
    }

    /// The unit that takes logarithms.
    fn log(&self, i: &In, d: &mut Self) {
        let value = match (i.scan, i.block_done, i.phase) {
            (false, true, _) => i.block_ended.get(),
            (false, false, _) => self.held_exposure.get(),
            (true, _, false) => self.excess[0].get().max(0) as u64,
            (true, _, true) => self.box_expected.get().max(1),
        };
        let bits = length(value as i64);
        let aligned = if bits > 7 { value >> (bits - 7) } else { value << (7 - bits) };
        (d.log_bits, d.log_part) = (U::new(bits.into()), U::new(aligned));
        let log = match self.log_bits.get() as i64 {
            0 => -64,
            bits => (bits - 1) * 64 + LOG2[self.log_part.index()],
        };
        if if i.scan { i.phase } else { self.block[0] } {
            d.upper_log = S::new(log);
        }
        if if i.scan { !i.phase } else { self.block[1] } {
            d.lower_log = S::new(log);
        }
    }

    /// Keeps the blocks with the lowest hazards.
    fn blocks(&self, i: &In, d: &mut Self) {
        shift(&mut d.block, i.block_done);
        d.held_exposure = i.block_exposure;
        if i.block_done {
            d.block_count = self.block_count + 1;
        }
        if self.block[2] {
            self.insert(d);
        }
        if i.load {
            (d.block_count, d.judged, d.exposed) = Default::default();
            d.lowest = [S::new(8191); 3];
            d.threshold = S::new(-8192);
        }
    }

    /// Puts a block into its place.
    fn insert(&self, d: &mut Self) {
        let (hazard, exposure) =
            (self.upper_log.get() - self.lower_log.get(), self.lower_log.get());
        d.judged = self.judged + 1;
        let first = self.judged == 0;
        if first {
            d.threshold = S::new(exposure - LEAST_EXPOSURE);
        }
        if !first && exposure <= self.threshold.get() {
            return;
        }
        d.exposed = self.exposed + 1;
        let lower = |k: usize| hazard < self.lowest[k].get();
        for k in 0..3 {
            if k > 0 && lower(k - 1) {
                (d.lowest[k], d.which[k]) = (self.lowest[k - 1], self.which[k - 1]);
            } else if lower(k) {
                (d.lowest[k], d.which[k]) = (S::new(hazard), self.judged);
            }
        }
    }

    /// Takes a bin, and what leaves the box for it.
    fn enter(&self, i: &In, p: &Params, kept: &Kept, d: &mut Self) {
        d.entered = i.slide;
        if !i.slide {
            return;
        }
        let added = if i.waits { ADDED } else { 0 };
        d.entering_excess = S::new((i.residual.get() << 4) - added);
        d.entering_expected = U::new((i.predicted.get() >> 4) + added as u64);
        d.entering_middle = i.middle;
        let full = self.count.get() >= p.box_bins as u64;
        let left = if full { *kept } else { Kept::default() };
        d.leaving_excess = left.excess;
        (d.leaving_expected, d.leaving_middle) = (left.predicted, left.middle);
        d.count = self.count + 1;
    }

    /// Slides the box on.
    fn slide(&self, p: &Params, d: &mut Self) {
        let mut excess = self.excess[0].get();
        let mut middle = self.box_middle[0].get();
        if self.entered {
            excess += self.entering_excess.get() - self.leaving_excess.get();
            let predicted = self.box_expected.get() + self.entering_expected.get();
            d.box_expected = U::new(predicted - self.leaving_expected.get());
            middle = middle + self.entering_middle.get() - self.leaving_middle.get();
        }
        shift(&mut d.excess, S::new(excess));
        shift(&mut d.box_middle, U::new(middle));
        // The box ends with the bin that entered: its place is so many bins before.
        let back = (p.box_bins - p.box_bins / 2) as u64;
        let place = U::new(self.count.get().saturating_sub(back));
        let within = self.count.get() >= back && place.get() < p.histogram.bins as u64;
        shift(&mut d.place, place);
        shift(&mut d.boxed, self.entered && within);
    }

    /// Compares a box with the highest one.
    fn judge(&self, d: &mut Self) {
        let above = self.excess[1].get() > 0;
        let score = 2 * self.upper_log.get() - self.lower_log.get() - 512;
        d.score = S::new(if above { score } else { NONE });
        if self.boxed[2] && self.score.get() > self.best_score.get() {
            (d.best_score, d.best_place) = (self.score, self.place[2]);
            (d.best_excess, d.best_middle) = (self.excess[2], self.box_middle[2]);
        }
    }
}
