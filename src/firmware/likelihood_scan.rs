//! Where a box stands highest above ambient light, in the likelihood estimator, and how much of that there is.
//!
//! Mirrors `rtl_ref/likelihood_scan.v`. In a scan a box slides over the bins. The memory keeps what entered it
//! until it leaves. What enters is added to the box in the first cycle of a beat, and what leaves is subtracted in
//! the second. One unit takes logarithms: of a box's excess in the first cycle of a beat and of what is expected in
//! the second, and in a load those of a block of bins.
//!
//! ```text
//! beat       k           k + 1               k + 3     k + 4   k + 5
//! registers  entering    excess, expected    logs      score   best
//! ```
//!
//! Of eight blocks, as far as they have a 64th of the first one's exposure, the one at 3/8 of the order of hazards
//! is kept: it is among the lowest three.

use crate::kernel::{S, U};
use crate::{module_of_registers, signals};

use super::histogram_builder::{Bin, Count, MOST_BINS};
use super::likelihood_estimator::params::Params;
use super::likelihood_memory::{Exposure, Place, Waiting};
use super::likelihood_terms::{Expected, Residual};

mod blocks;
mod logarithm;
mod sliding;

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
        #[size(RestBits)]
        pub block_ended: Waiting,
        /// Its exposure [shots units].
        #[size(ExposureBits)]
        pub block_exposure: Exposure,
        /// Begins a pass.
        pub pass: bool,
        /// The pass is a scan.
        pub scan: bool,
        /// Second cycle of a beat.
        pub phase: bool,
        /// A bin of a scan, or a beat after the last one, comes.
        pub slide: bool,
        /// n k - R lambda, 0 of what is no bin.
        #[size(ResidualBits)]
        pub residual: Residual,
        /// R lambda.
        #[size(ExpectedBits)]
        pub predicted: Expected,
        /// Twice the shots that wait in the middle of the bin.
        #[size(MiddleBits)]
        pub middle: U<25>,
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
        #[size(ExcessBits)]
        #[view(heading = "Likelihood", probe = true)]
        pub best_excess: Excess,
        /// Twice the shots that wait in the middle of a bin, over its bins.
        #[size(BoxMiddleBits)]
        pub best_middle: U<35>,
        /// Bins in it.
        #[size(PlaceBits)]
        pub box_length: Place,
        /// Its first bin and the one after its last, together.
        #[size(BoxSumBits)]
        pub box_sum: U<12>,
        /// Hits of the block that shows the ambient light.
        #[size(CountBits)]
        pub ambient_ended: Count,
        /// Its exposure [shots units].
        #[size(ExposureBits)]
        pub ambient_exposure: Exposure,
        /// The kept block is the only one.
        pub lone: bool,
        /// Bins that have come.
        #[size(PlaceBits)]
        count: Place,
        /// The last of them.
        #[size(BinBits)]
        newest: Bin,
        /// First bin of the box, negative before bin 0.
        #[size(BoxSumBits)]
        oldest: S<12>,
        /// Its middle.
        #[size(BoxSumBits)]
        centre: S<12>,
        /// A bin has come.
        entered: bool,
        /// Its excess.
        #[size(BoxTermBits)]
        entering_excess: S<39, 8>,
        /// Expected count of the entering bin, 8 fraction bits.
        #[size(BoxTermBits)]
        entering_expected: U<39>,
        /// Twice the shots that wait in its middle.
        #[size(MiddleBits)]
        entering_middle: U<25>,
        /// Excess of the bin that leaves the box.
        #[size(BoxTermBits)]
        leaving_excess: S<39, 8>,
        /// Expected.
        #[size(BoxTermBits)]
        leaving_expected: U<39>,
        /// Twice the shots that wait.
        #[size(MiddleBits)]
        leaving_middle: U<25>,
        /// Excess of the box, and as it goes along.
        #[size(ExcessBits)]
        excess: [Excess; 4],
        /// Expected in the box.
        #[size(BoxExpectedBits)]
        box_expected: U<48>,
        /// Twice the shots that wait, and as they go along.
        #[size(BoxMiddleBits)]
        box_middle: [U<35>; 4],
        /// The box as it was in the first cycle of the beat: its excess.
        #[size(ExcessBits)]
        held_excess: Excess,
        /// Expected.
        #[size(BoxExpectedBits)]
        held_expected: U<48>,
        /// Twice the shots that wait.
        #[size(BoxMiddleBits)]
        held_middle: U<35>,
        /// The box is within the histogram.
        boxed: [bool; 4],
        /// Its first bin in the histogram.
        #[size(PlaceBits)]
        from: [Place; 4],
        /// The one after its last.
        #[size(PlaceBits)]
        until: [Place; 4],
        /// The number whose logarithm is taken.
        #[size(BoxExpectedBits)]
        log_number: U<48>,
        /// Top of the number whose logarithm is taken, raised until its leading one is in the upper 16 bits.
        log_value: U<22>,
        /// High bits of the place of its leading one.
        log_high: U<2>,
        /// Top of the number, shifted until its leading one is in the upper 4 bits.
        log_mantissa: U<22>,
        /// All but the low bits of that one's place.
        log_middle: U<4>,
        /// The number is an expected count, which is at least 1.
        log_expected: [bool; 3],
        /// Logarithm of an excess or of hits.
        upper_log: Log,
        /// Logarithm of what is expected or of an exposure.
        lower_log: Log,
        /// Score of the box.
        score: Log,
        /// First bin of the highest box.
        #[size(PlaceBits)]
        best_from: Place,
        /// The one after its last.
        #[size(PlaceBits)]
        best_until: Place,
        /// Exposure of the block.
        #[size(ExposureBits)]
        held_exposure: Exposure,
        /// A block is in the logarithms.
        block: [bool; 5],
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

/// Values that enter and leave a box.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Kept {
    excess: S<39, 8>,
    predicted: U<39>,
    middle: U<25>,
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

module_of_registers!(LikelihoodScan);

impl LikelihoodScan {
    /// The rising edge of `clk_sys`.
    pub fn rise(&mut self, i: &In, p: &Params) {
        let (q, d) = (self.registers, self.next(i, p));
        if i.block_done {
            self.blocks[q.block_count.index()] = (i.block_ended, i.block_exposure);
        }
        if i.phase && q.entered {
            self.kept[q.newest.index()] = Kept {
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
        q.log(i, p, &mut d);
        q.blocks(i, &mut d);
        let pick = (q.exposed.get().wrapping_sub(1) & 15) * 3 / 8;
        let block = self.blocks[q.which[(pick as usize).min(2)].index()];
        let most = p.histogram.most_hits();
        (d.ambient_ended, d.ambient_exposure) = (U::new(block.0.get().min(most)), block.1);
        d.lone = q.exposed == 1;
        q.change(i, &mut d);
        if i.phase {
            let leaving = q.oldest.get().rem_euclid(p.histogram.bins as i64);
            q.enter(i, p, &self.kept[leaving as usize], &mut d);
            q.slide(p, &mut d);
            q.judge(&mut d);
        }
        let (from, until) = (q.best_from.get(), q.best_until.get());
        (d.box_length, d.box_sum) = (U::new(until.wrapping_sub(from)), U::new(from + until));
        if i.pass && i.scan {
            d.begin(p);
        }
        d
    }
}
