//! Argmax with centroid correction: the depth estimator that a network is measured against.
//!
//! Mirrors `rtl_ref/centroid_estimator.v`; its ports are those of the estimator slot. A window
//! of 2 W + 1 words slides over the histogram. Where its centre stands highest above the background
//! (the first such place), the centroid of the window is taken, in 1/4096 of a bin, and
//! depth = slope (centroid + 1/2) + offset: bin i is centred at i + 1/2. Edge e0 takes `algo_start`:
//!
//! ```text
//! cycle      e0 .. e255   e256 .. e289   e290 .. e307   e308       e309, e310      e311    e312
//! next edge  word         no word        quotient bit   position   distance        depth   -
//! read_en    ^^^^^^^^^^
//! algo_done                                                                                ^^^^
//! ```
//!
//! A word, and the window that ends before it, go through three registers:
//!
//! ```text
//! edge       e(s+1)                             e(s+2)                     e(s+3)
//! registers  entering, leaving, level, centre   change, weighted, height   sum, ages, best ..
//! ```
//!
//! That is with the KC705's 256 bins: 312 cycles, 2.496 us, for every W; with others 56 more than there are
//! bins. A start while busy is ignored; one in the cycle of `algo_done` is taken.

use crate::kernel::{S, U};
use crate::{module_of_registers, signals};

use super::forward2::Depth;
use super::histogram_builder::{self, Bin, Count};
use super::tof_top::slot::{EstimateWords, SlotEstimator, SlotOut};

pub use super::tof_top::slot::HistogramIn as In;

mod params;
mod window;

use params::QUOTIENT_BITS;
pub use params::{
    MOST_HALF_WIDTH, Offset, POSITION_FRACTION, Params, Position, SLOPE_FRACTION, Slope,
    position_bits,
};

/// Words that the window can remember.
const WORDS: usize = 64;
/// Bits of the position that one multiplier takes.
const FINE_BITS: u32 = 18;

/// Fraction bits of the product that a depth word does not have.
pub const SURPLUS: u32 = POSITION_FRACTION + SLOPE_FRACTION - 29;

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Registers {
        /// The histogram's word at `read_addr` is being read.
        pub read_en: bool,
        /// Word of the histogram.
        #[size(BinBits)]
        pub read_addr: Bin,
        /// The depth, when `algo_done` is high, and until the next one [m].
        pub depth: Depth,
        /// The depth is ready; one cycle.
        pub algo_done: bool,
        /// An estimation is under way.
        busy: bool,
        /// Cycles since e0.
        #[size(CentroidStepBits)]
        step: U<11>,
        /// The window has all its words.
        whole: bool,
        /// Place of its first word, of word 0 before that.
        first: U<6>,
        /// The word that enters the window [hits].
        #[size(CountBits)]
        entering: Count,
        /// The word that leaves it [hits].
        #[size(CountBits)]
        leaving: Count,
        /// Background at its centre [hits].
        #[size(CountBits)]
        level: Count,
        /// The word at its centre [hits].
        #[size(CountBits)]
        centre: Count,
        /// Change of `sum` by `entering` and `leaving` [hits].
        #[size(ChangeBits)]
        change: S<25>,
        /// `leaving`, as often as the window has words.
        #[size(WindowBits)]
        weighted: U<30>,
        /// `centre` above `level`, 0 below it or where none is [hits].
        #[size(CountBits)]
        height: Count,
        /// Hits in the window.
        #[size(WindowBits)]
        #[view(heading = "Estimator", curve = true, probe = true)]
        sum: U<30>,
        /// Hits in the window, each times the words that came after its own.
        #[size(AgesBits)]
        #[view(probe = true)]
        ages: U<35>,
        /// Height of the highest centre [hits].
        #[size(CountBits)]
        #[view(heading = "Estimator", probe = true)]
        best: Count,
        /// Its bin.
        #[size(BinBits)]
        #[view(heading = "Estimator", probe = true)]
        peak: Bin,
        /// Hits in its window: the divisor.
        #[size(WindowBits)]
        best_sum: U<30>,
        /// `ages` of its window, then what the division leaves of it.
        #[size(RemainderBits)]
        remainder: U<37>,
        /// Mean age of the hits in its window, 12 fraction bits [bins].
        #[view(heading = "Estimator", probe = true)]
        quotient: U<18>,
        /// Centroid from the begin of bin 0, 12 fraction bits [bins].
        #[size(PositionBits)]
        position: U<22>,
        /// The low bits of `position` times slope [2^-36 m].
        fine: U<35>,
        /// The bits above them times slope [2^-18 m].
        #[size(PositionCoarseBits)]
        coarse: U<21>,
        /// `position` times slope [2^-29 m].
        #[size(DistanceBits)]
        distance: U<32>,
    }
}

/// Registers and the window's memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CentroidEstimator {
    /// Registers.
    pub registers: Registers,
    /// The last words, each at its number plus one modulo 64; without reset [hits].
    window: [Count; WORDS],
}

impl Default for CentroidEstimator {
    fn default() -> Self {
        CentroidEstimator { registers: Registers::default(), window: [U::new(0); WORDS] }
    }
}

module_of_registers!(CentroidEstimator);

impl SlotEstimator for CentroidEstimator {
    type In = In;
    type Params = Params;

    fn params_for(histogram: &histogram_builder::Params) -> Params {
        Params { histogram: *histogram, ..Params::default() }
    }

    fn rise(&mut self, i: &In, p: &Params) {
        let q = self.registers;
        self.registers = if i.rst { Registers::default() } else { self.next(i, p) };
        if q.busy && q.step.get() < p.divide() {
            self.window[q.step.index() % WORDS] = q.entering;
        }
    }

    #[inline(always)]
    fn outputs(&self) -> SlotOut {
        let Registers { read_en, read_addr, depth, algo_done, .. } = self.registers;
        SlotOut { read_en, read_addr, words: EstimateWords::of_depth(depth), algo_done }
    }

    fn cycles(p: &Params) -> u64 {
        p.done()
    }

    fn phase(&self, p: &Params) -> Option<u64> {
        self.registers.phase(p)
    }

    fn rests(&self, i: &In, p: &Params) -> bool {
        let mut next = *self;
        next.rise(i, p);
        next == *self
    }
}

impl CentroidEstimator {
    fn next(&self, i: &In, p: &Params) -> Registers {
        let (q, mut d) = (&self.registers, self.registers);
        d.algo_done = false;
        d.fine = U::new((q.position.get() & ((1 << FINE_BITS) - 1)) * p.slope.get());
        d.coarse = U::new((q.position.get() >> FINE_BITS) * p.slope.get());
        d.distance = U::new(((q.coarse.get() << FINE_BITS) + q.fine.get()) >> SURPLUS);
        if !q.busy {
            if i.algo_start {
                d = Registers { busy: true, read_en: true, depth: q.depth, ..Registers::default() };
            }
            return d;
        }
        d.step = q.step + 1;
        d.read_en = d.step.get() < p.histogram.bins as u64;
        d.read_addr = U::new(if d.read_en { d.step.get() } else { 0 });
        let step = q.step.get();
        if step < p.divide() {
            self.look(i, p, &mut d);
            q.weigh(p, &mut d);
            q.slide(p, &mut d);
        } else if step < p.place() {
            q.divide(&mut d);
        } else if step == p.place() {
            let (end, half) = (q.peak.get() + p.half_width, 1 << (POSITION_FRACTION - 1));
            let position = (end << POSITION_FRACTION) + half;
            let most = (1 << position_bits(&p.histogram)) - 1;
            d.position = U::new(position.wrapping_sub(q.quotient.get()) & most);
        } else if step == p.last() {
            let depth = q.distance.get() as i64 + p.offset.get();
            d.depth = Depth::new(if q.best != 0 { depth } else { 0 });
            (d.algo_done, d.busy, d.step) = (true, false, U::new(0));
        }
        d
    }
}

impl Registers {
    /// Cycles since e0, up to the one of `algo_done`.
    pub fn phase(&self, p: &Params) -> Option<u64> {
        if self.algo_done { Some(p.done()) } else { self.busy.then(|| self.step.get()) }
    }

    /// One bit of `remainder` / `best_sum`, by restoring division.
    fn divide(&self, d: &mut Registers) {
        let divisor = self.best_sum.get() << (QUOTIENT_BITS - POSITION_FRACTION);
        let shifted = self.remainder.get() << 1;
        let fits = shifted >= divisor;
        d.remainder = U::new(if fits { shifted - divisor } else { shifted });
        d.quotient = U::new(self.quotient.get() << 1 | u64::from(fits));
    }
}

#[cfg(test)]
mod tests;
