//! Argmax with centroid correction: the depth estimator that a network is measured against.
//!
//! Mirrors `rtl_ref/centroid_estimator.v`; its ports are those of [`super::depth_estimator`]. A window
//! of 2 W + 1 words slides over the histogram. Where its centre stands highest above the background
//! (the first such place), the centroid of the window is taken, in 1/4096 of a bin, and
//! depth = slope (centroid + 1/2) + offset: bin i is centred at i + 1/2. Edge e0 takes `algo_start`:
//!
//! ```text
//! cycle      e0 .. e255   e256 .. e287   e288 .. e305   e306       e307    e308
//! next edge  word         no word        quotient bit   position   depth   -
//! read_en    ^^^^^^^^^^
//! algo_done                                                                ^^^^
//! ```
//!
//! 308 cycles, 2.464 us, for every W. A start while busy is ignored; one in the cycle of `algo_done`
//! is taken.

use crate::kernel::module::{Module, Visitor};
use crate::kernel::{S, U};
use crate::signals;

use super::forward2::Depth;
use super::histogram_builder::BINS;

/// Largest W [bins].
pub const MOST_HALF_WIDTH: u64 = 31;
/// Words that the window can remember.
const WORDS: usize = 64;
/// First cycle of the division, when the last centre has been looked at with any W.
pub const DIVIDE: u64 = BINS as u64 + MOST_HALF_WIDTH + 1;
/// Bits of the quotient: 6 before the point, 12 after it.
const QUOTIENT_BITS: u32 = 18;
/// Fraction bits of quotient and position.
pub const POSITION_FRACTION: u32 = 12;
/// Cycle before the edge that makes the position.
pub const PLACE: u64 = DIVIDE + QUOTIENT_BITS as u64;
/// Cycle in which the depth is ready: the estimator's latency [cycles of clk_125].
pub const DONE: u64 = PLACE + 2;

/// Distance of a bin, 24 fraction bits [m].
pub type Slope = U<17>;
/// Fraction bits of [`Slope`].
pub const SLOPE_FRACTION: u32 = 24;
/// Distance that is added [m].
pub type Offset = S<30, 29>;
/// Fraction bits of the product that a depth word does not have.
pub const SURPLUS: u32 = POSITION_FRACTION + SLOPE_FRACTION - 29;

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// Starts an estimation.
        pub algo_start: bool,
        /// Word of the histogram at `read_addr` [hits].
        pub count: U<16>,
    }
}

/// Verilog parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// W: words of the window to either side of its centre, 1 to 31 [bins].
    pub half_width: u64,
    /// Whether height is counted from the window's first word and not from zero.
    pub background: bool,
    /// Distance of a bin.
    pub slope: Slope,
    /// Distance that is added.
    pub offset: Offset,
}

impl Default for Params {
    /// As the Verilog: W = 23, above the background, c/2 for 25 ps a bin, no offset.
    fn default() -> Self {
        Params { half_width: 23, background: true, slope: U::new(62_871), offset: S::new(0) }
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Registers {
        /// The histogram's word at `read_addr` is being read.
        pub read_en: bool,
        /// Word of the histogram.
        pub read_addr: U<8>,
        /// The depth, when `algo_done` is high, and until the next one.
        pub depth: Depth,
        /// The depth is ready; one cycle.
        pub algo_done: bool,
        /// An estimation is under way.
        busy: bool,
        /// Cycles since e0.
        step: U<9>,
        /// Hits in the window.
        #[view(heading = "Estimator", curve = true, probe = true)]
        sum: U<22>,
        /// Hits in the window, each times the words that came after its own.
        #[view(probe = true)]
        ages: U<27>,
        /// Height of the highest centre [hits].
        #[view(heading = "Estimator", probe = true)]
        best: U<16>,
        /// Its bin.
        #[view(heading = "Estimator", probe = true)]
        peak: U<8>,
        /// Hits in its window: the divisor.
        best_sum: U<22>,
        /// `ages` of its window, then what the division leaves of it.
        remainder: U<29>,
        /// Mean age of the hits in its window, 12 fraction bits [bins].
        #[view(heading = "Estimator", probe = true)]
        quotient: U<18>,
        /// Centroid from the begin of bin 0, 12 fraction bits [bins].
        position: U<20>,
    }
}

/// Registers and the window's memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CentroidEstimator {
    /// Registers.
    pub registers: Registers,
    /// The last words, each at its number modulo 64; without reset [hits].
    window: [U<16>; WORDS],
}

impl Default for CentroidEstimator {
    fn default() -> Self {
        CentroidEstimator { registers: Registers::default(), window: [U::new(0); WORDS] }
    }
}

impl Module for CentroidEstimator {
    const COUNT: usize = <Registers as Module>::COUNT;

    #[inline(always)]
    fn visit(&self, then: Option<&mut Self>, visitor: &mut impl Visitor) {
        visitor.signals("registers", &self.registers, then.map(|then| &mut then.registers));
    }
}

impl CentroidEstimator {
    /// The rising edge of `clk_125`.
    pub fn rise(&mut self, i: &In, p: &Params) {
        let q = self.registers;
        self.registers = if i.rst { Registers::default() } else { self.next(i, p) };
        if q.busy && q.step.get() < DIVIDE {
            self.window[q.step.index() % WORDS] = q.entering(i);
        }
    }

    fn next(&self, i: &In, p: &Params) -> Registers {
        let (q, mut d) = (&self.registers, self.registers);
        d.algo_done = false;
        if !q.busy {
            if i.algo_start {
                d = Registers { busy: true, read_en: true, depth: q.depth, ..Registers::default() };
            }
            return d;
        }
        d.step = q.step + 1;
        d.read_en = d.step.get() < BINS as u64;
        d.read_addr = U::new(if d.read_en { d.step.get() } else { 0 });
        match q.step.get() {
            ..DIVIDE => self.slide(i, p, &mut d),
            DIVIDE..PLACE => q.divide(&mut d),
            PLACE => {
                let (end, half) = (q.peak.get() + p.half_width, 1 << (POSITION_FRACTION - 1));
                d.position = U::new((end << POSITION_FRACTION) + half) - q.quotient.get();
            }
            _ => {
                let product = (q.position.get() * p.slope.get()) >> SURPLUS;
                let found = q.best != 0;
                d.depth = Depth::new(if found { product as i64 + p.offset.get() } else { 0 });
                (d.algo_done, d.busy, d.step) = (true, false, U::new(0));
            }
        }
        d
    }

    /// Looks at the window that ends before this cycle's word, and lets that word in.
    fn slide(&self, i: &In, p: &Params, d: &mut Registers) {
        let (q, words) = (&self.registers, 2 * p.half_width + 1);
        let word = |number: u64| self.window[number as usize % WORDS].get();
        let step = q.step.get();
        let whole = step >= words;
        let first = word(if whole { step - words } else { 0 });
        let leaving = if whole { first } else { 0 };
        let level = match p.background {
            true if whole => first,
            true => 2 * first,
            false => 0,
        };
        if step > p.half_width {
            let peak = step - 1 - p.half_width;
            let centre = word(peak);
            if centre > level + q.best.get() {
                (d.best, d.peak) = (U::new(centre - level), U::new(peak));
                (d.best_sum, d.remainder) = (q.sum, U::new(q.ages.get()));
            }
        }
        d.sum = q.sum + q.entering(i).get() - leaving;
        d.ages = q.ages + q.sum.get() - words * leaving;
    }
}

impl Registers {
    /// Cycles since e0, up to the one of `algo_done`.
    pub fn phase(&self) -> Option<u64> {
        if self.algo_done { Some(DONE) } else { self.busy.then(|| self.step.get()) }
    }

    /// The word that this cycle lets into the window; none is zero.
    fn entering(&self, i: &In) -> U<16> {
        if self.read_en { i.count } else { U::new(0) }
    }

    /// One bit of `remainder` / `best_sum`, by restoring division.
    fn divide(&self, d: &mut Registers) {
        let divisor = self.best_sum.get() << (QUOTIENT_BITS - POSITION_FRACTION);
        let shifted = U::<29>::new(self.remainder.get() << 1);
        let fits = shifted.get() >= divisor;
        d.remainder = if fits { shifted - divisor } else { shifted };
        d.quotient = U::new(self.quotient.get() << 1 | u64::from(fits));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const IDLE: In = In { rst: false, algo_start: false, count: U::new(0) };
    const GO: In = In { algo_start: true, ..IDLE };

    /// The block in each cycle from e0 on, over a histogram, with the inputs `at` says.
    fn cycles(histogram: &[u64; BINS], at: impl Fn(u64) -> In) -> Vec<Registers> {
        let mut block = CentroidEstimator::default();
        block.rise(&GO, &Params::default());
        (0..700)
            .map(|cycle| {
                let now = block.registers;
                let count = if now.read_en { histogram[now.read_addr.index()] } else { 999 };
                block.rise(&In { count: U::new(count), ..at(cycle) }, &Params::default());
                now
            })
            .collect()
    }

    fn one(bin: usize) -> [u64; BINS] {
        std::array::from_fn(|k| if k == bin { 50 } else { 0 })
    }

    #[test]
    fn the_depth_is_ready_308_edges_after_the_start_is_taken() {
        let cycles = cycles(&one(100), |_| IDLE);
        let done: Vec<_> = (0..700).filter(|&cycle| cycles[cycle].algo_done).collect();
        assert_eq!(done, [308]);
        let metres = cycles[308].depth.to_f64();
        assert!((metres - 100.5 * 0.003_747_405_725).abs() < 1e-6, "{metres}");
        assert_eq!(cycles[699].depth, cycles[308].depth);
    }

    #[test]
    fn each_word_is_read_once_and_in_order() {
        let cycles = cycles(&one(100), |_| IDLE);
        let read = cycles.iter().filter(|now| now.read_en).map(|now| now.read_addr.get());
        assert!(read.eq(0..256));
    }

    #[test]
    fn a_start_while_busy_is_ignored_and_one_with_algo_done_is_taken() {
        let at = |again| move |cycle| if cycle == again { GO } else { IDLE };
        assert_eq!(cycles(&one(100), at(307)), cycles(&one(100), |_| IDLE));
        let again = cycles(&one(100), at(308));
        assert!(again[309].read_en && again[308 + 309].algo_done);
    }

    #[test]
    fn a_reset_drops_everything_and_leaves_no_trace_in_the_next_estimation() {
        let reset = |cycle| In { rst: cycle == 200, algo_start: cycle == 210, ..IDLE };
        let cycles = cycles(&one(100), reset);
        assert_eq!(cycles[201], Registers::default());
        assert_eq!(cycles.iter().position(|now| now.algo_done), Some(211 + 308));
        let metres = cycles[211 + 308].depth.to_f64();
        assert!((metres - 100.5 * 0.003_747_405_725).abs() < 1e-6, "{metres}");
    }

    #[test]
    fn nothing_stands_out_of_an_empty_or_a_full_histogram() {
        for histogram in [[0; BINS], [65_535; BINS]] {
            assert_eq!(cycles(&histogram, |_| IDLE)[308].depth, Depth::new(0));
        }
    }
}
