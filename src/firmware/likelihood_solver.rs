//! The arithmetic between the passes of the likelihood estimator: a small machine with one multiplier.
//!
//! Mirrors `rtl_ref/likelihood_solver.v`. An instruction takes five cycles: it reads its operands, multiplies with
//! the low 17 bits of `b` and with the others, shifts, and adds. A reciprocal takes 17 more, a root 25, a bit of
//! each at a time. The programs are in [`program`]: the ambient light of a block, a point from the box, a step of
//! Fisher scoring, and what comes out at the end.

use crate::kernel::module::{Module, Visitor};
use crate::kernel::{S, U, wrapped};
use crate::signals;

use super::histogram_builder::Count;
use super::likelihood_estimator::params::Params;
use super::likelihood_estimator::tables::length;
use super::likelihood_memory::{Exposure, Place};
use super::likelihood_scan::Excess;

pub mod program;

use program::{By, Clamp, Instruction, Mark, ONE, Op, PROGRAM};

/// A word of the memory, and the most bits of one.
pub type Word = S<45>;
/// Words of the memory.
const WORDS: usize = 32;
/// Bits of `b` that the multiplier takes first.
const LOW_BITS: u32 = 17;
/// Largest S or b.
const MOST: i64 = (1 << 24) - 1;
/// Smallest S.
const LEAST_SIGNAL: i64 = 16;
/// Largest chance, a half.
const MOST_CHANCE: i64 = 1 << 23;
/// Limits of a step in log b: it falls to a half at most, and grows by three times.
const GROWTH: [i64; 2] = [-(1 << 13), 3 << 14];

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// Begins a program.
        pub run: bool,
        /// Where it begins.
        pub entry: U<7>,
        /// Hits of the block that shows the ambient light.
        #[size("CountBits")]
        pub ambient_ended: Count,
        /// Its exposure [shots units].
        #[size("ExposureBits")]
        pub ambient_exposure: Exposure,
        /// It is the only one.
        pub lone: bool,
        /// Excess of the highest box.
        #[size("ExcessBits")]
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
        /// Sums of the last pass.
        #[size("SquareSumBits")]
        pub sum_11: S<44>,
        /// See there.
        #[size("SlopeSumBits")]
        pub sum_12: S<48>,
        /// See there.
        #[size("SlopeSumBits")]
        pub sum_13: S<48>,
        /// See there.
        #[size("SumWordBits")]
        pub sum_22: S<43>,
        /// See there.
        #[size("SumWordBits")]
        pub sum_23: S<43>,
        /// See there.
        #[size("SumWordBits")]
        pub sum_33: S<43>,
        /// See there.
        #[size("SlopeSumBits")]
        pub score_1: S<48>,
        /// See there.
        #[size("SumWordBits")]
        pub score_2: S<43>,
        /// See there.
        #[size("SumWordBits")]
        pub score_3: S<43>,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Registers {
        /// A program has ended; one cycle.
        pub ran: bool,
        /// Arrival of the echo [units / 16].
        #[size("ArrivalBits")]
        #[view(heading = "Likelihood", curve = true, probe = true)]
        pub arrival: U<21>,
        /// S, 14 fraction bits [photons a shot].
        #[view(heading = "Likelihood", probe = true)]
        pub strength: U<24>,
        /// b, 30 fraction bits [1 / unit].
        #[view(heading = "Likelihood", probe = true)]
        pub ambient: U<24>,
        /// Depth of the last end program [2^-29 m].
        pub depth: S<36, 29>,
        /// Its deviation [2^-29 m].
        pub sigma: U<36>,
        /// Flags of the last end program.
        pub flags: U<7>,
        /// By how many bits the last step was shortened.
        pub cut: U<6>,
        /// A program is running.
        running: bool,
        /// Its instruction.
        #[view(heading = "Likelihood", probe = true)]
        counter: U<7>,
        /// Cycle of it.
        cycle: U<5>,
        /// Operands.
        #[size("WordBits")]
        a: Word,
        /// See there.
        #[size("WordBits")]
        b: Word,
        /// See there.
        #[size("WordBits")]
        c: Word,
        /// a times the low bits of b.
        #[size("LowProductBits")]
        low: S<63>,
        /// a times b.
        product: S<64>,
        /// The product as it is shifted, or a divisor.
        #[size("ShiftedBits")]
        shifted: S<47>,
        /// Bits of what was divided by last, or half of those of a variance.
        bits: U<6>,
        /// By how many bits the rest of the information is shifted.
        exponent: U<6>,
        /// All magnitudes that were marked.
        #[size("WordBits")]
        magnitude: U<45>,
        /// What a division or a root leaves.
        remainder: U<28>,
        /// What it has come to.
        quotient: U<25>,
    }
}

/// Registers and memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LikelihoodSolver {
    /// Registers.
    pub registers: Registers,
    /// Variables and constants.
    words: [Word; WORDS],
}

impl Default for LikelihoodSolver {
    fn default() -> Self {
        LikelihoodSolver { registers: Registers::default(), words: [S::new(0); WORDS] }
    }
}

impl Module for LikelihoodSolver {
    const COUNT: usize = <Registers as Module>::COUNT;

    #[inline(always)]
    fn visit(&self, then: Option<&mut Self>, visitor: &mut impl Visitor) {
        visitor.signals("registers", &self.registers, then.map(|then| &mut then.registers));
    }
}

/// Cycles of an instruction: operands, both parts of the product, the shift, and the sum.
const ADD: u64 = 4;
/// Bits of a reciprocal, and of a root.
const RECIPROCAL_BITS: u64 = 17;
/// See there.
const ROOT_BITS: u64 = 25;

impl Params {
    /// The constants of the solver's memory, from [`ONE`] on.
    pub fn constants(&self) -> [i64; WORDS - ONE as usize] {
        let (kappa, stride, end) = (self.kappa, self.stride(), self.end());
        let (wide, margin) = (self.sigma << 4, self.sigma << 3);
        [1, kappa, stride, self.metres, 341, 19, 1 << LOW_BITS, 0, wide, margin, end, 64, 40, 2]
    }

    /// Limits of a result.
    fn limits(&self, clamp: Clamp) -> [i64; 2] {
        let most = 1 << (self.word_bits() - 1);
        match clamp {
            Clamp::Word => [-most, most - 1],
            Clamp::Positive => [1, most - 1],
            Clamp::Signal => [LEAST_SIGNAL, MOST],
            Clamp::Ambient => [1, MOST],
            Clamp::Chance => [1, MOST_CHANCE],
            Clamp::Window => [0, self.end()],
            Clamp::Growth => GROWTH,
        }
    }
}

impl LikelihoodSolver {
    /// The instruction that it is at.
    pub fn counter(&self) -> u64 {
        self.registers.counter.get()
    }

    /// Whether no edge changes anything until an input does.
    pub fn rests(&self, i: &In) -> bool {
        !i.rst && !i.run && !self.registers.running && !self.registers.ran
    }

    /// The rising edge of `clk_sys`.
    pub fn rise(&mut self, i: &In, p: &Params) {
        let q = self.registers;
        let mut d = q;
        d.ran = false;
        if i.run {
            (d.running, d.counter, d.cycle) = (true, i.entry, U::new(0));
            d.magnitude = U::new(0);
        } else if q.running {
            let now = &PROGRAM[q.counter.index() % PROGRAM.len()];
            match now.op {
                Op::End => (d.running, d.ran) = (false, true),
                Op::Exponent | Op::Cut => q.measure(now.op, &mut d),
                Op::Alu | Op::Reciprocal | Op::Root => {
                    d.cycle = q.cycle + 1;
                    self.fetch(now, i, p, &mut d);
                    q.multiply(now, p, &mut d);
                    q.digit(now.op, &mut d);
                    if let Some(result) = q.result(now, p) {
                        (d.cycle, d.counter) = (U::new(0), q.counter + 1);
                        self.keep(now, result, &mut d);
                    }
                }
            }
        }
        self.registers = if i.rst { Registers::default() } else { d };
    }

    /// Reads the operands.
    fn fetch(&self, now: &Instruction, i: &In, p: &Params, d: &mut Registers) {
        if self.registers.cycle != 0 {
            return;
        }
        let word = |place: u8| match place.checked_sub(ONE) {
            Some(constant) => p.constants()[constant as usize],
            None => self.words[place as usize].get(),
        };
        let fit = |value: i64| S::new(wrapped(value, p.word_bits()));
        d.a = fit(i.first_operand(now.a).unwrap_or_else(|| word(now.a)));
        d.b = S::new(word(now.b));
        d.c = fit(i.third_operand(now.c).unwrap_or_else(|| word(now.c)));
    }

    /// Writes a result.
    fn keep(&mut self, now: &Instruction, result: i64, d: &mut Registers) {
        match now.to {
            program::DEPTH => d.depth = S::new(result),
            program::SIGMA => d.sigma = U::new(result as u64),
            to => self.words[to as usize] = S::new(result),
        }
        match now.to {
            program::ARRIVAL => d.arrival = U::new(result as u64),
            program::SIGNAL => d.strength = U::new(result as u64),
            program::AMBIENT => d.ambient = U::new(result as u64),
            _ => {}
        }
        match now.mark {
            Mark::Nothing => {}
            Mark::Magnitude => {
                d.magnitude = U::new(self.registers.magnitude.get() | result.unsigned_abs());
            }
            Mark::Flag(flag) => {
                let others = self.registers.flags.get() & !(1 << flag);
                d.flags = U::new(others | u64::from(result < 0) << flag);
            }
        }
    }
}

impl In {
    /// What `a` has from another block.
    fn first_operand(&self, place: u8) -> Option<i64> {
        Some(match place.checked_sub(WORDS as u8)? {
            0 => self.sum_13.get() >> 5,
            1 => self.sum_23.get(),
            2 => self.sum_33.get(),
            3 => self.score_3.get() << 2,
            4 if self.lone => (self.ambient_ended.get() << 12) as i64,
            4 => (self.ambient_ended.get() << 16) as i64,
            5 => self.ambient_exposure.get() as i64,
            6 => self.best_excess.get() << 4,
            7 => self.best_middle.get() as i64,
            8 => self.box_length.get() as i64,
            _ => (self.box_sum.get() << 9) as i64,
        })
    }

    /// What `c` has from another block.
    fn third_operand(&self, place: u8) -> Option<i64> {
        Some(match place.checked_sub(WORDS as u8)? {
            0 => self.sum_11.get() >> 1,
            1 => self.sum_12.get() >> 5,
            2 => self.sum_22.get(),
            3 => self.score_1.get() >> 3,
            _ => self.score_2.get() << 2,
        })
    }
}

impl Registers {
    /// How large what has been marked is.
    fn measure(&self, op: Op, d: &mut Self) {
        let bits = u64::from(length(self.magnitude.get() as i64));
        match op {
            Op::Cut => d.cut = U::new(bits.saturating_sub(14)),
            _ => d.exponent = U::new(bits.saturating_sub(16)),
        }
        d.magnitude = U::new(0);
        d.counter = self.counter + 1;
    }

    /// The product, and the shift.
    fn multiply(&self, now: &Instruction, p: &Params, d: &mut Self) {
        let (a, b) = (self.a.get(), self.b.get());
        match self.cycle.get() {
            1 => {
                d.low = S::new(a * (b & ((1 << LOW_BITS) - 1)));
                if now.op == Op::Reciprocal {
                    d.bits = U::new(length(a.max(1)).into());
                }
            }
            2 => {
                let high = a.wrapping_mul(b >> LOW_BITS).wrapping_mul(1 << LOW_BITS);
                d.product = S::new(self.low.get().wrapping_add(high));
            }
            3 if now.op == Op::Root => {
                d.product = S::new(self.product.get() << (16 + self.odd()));
            }
            3 => d.shifted = S::new(self.shift(now, p)),
            _ => {}
        }
    }

    /// Whether a variance's exponent is odd.
    fn odd(&self) -> u64 {
        (self.bits.get() + self.exponent.get()) & 1
    }

    /// The product as the instruction shifts it; a divisor is not rounded.
    fn shift(&self, now: &Instruction, p: &Params) -> i64 {
        let by = match now.by {
            By::Nothing => 0,
            By::Bits => self.bits.get(),
            By::Exponent => self.exponent.get(),
            By::Cut => self.cut.get(),
            By::Both => self.bits.get() + self.exponent.get(),
            By::Metres => p.metres_shift.into(),
        };
        let bits = (u64::from(now.shift) + by).min(63);
        let (product, width) = (self.product.get(), p.word_bits() + 2);
        let (down, half) = match bits {
            0 => (product, 0),
            bits => (product >> bits, product >> (bits - 1) & 1),
        };
        // One place is left for the rounding.
        let most = 1 << (width - 2);
        match (-most..most).contains(&down) {
            true if now.op == Op::Reciprocal => down,
            true => down + half,
            false if down < 0 => -2 * most,
            false => 2 * most - 1,
        }
    }

    /// A bit of a reciprocal or of a root.
    fn digit(&self, op: Op, d: &mut Self) {
        if op == Op::Alu || self.cycle.get() < ADD {
            return;
        }
        let (left, against) = match op {
            Op::Root => {
                let next = (self.product.get() as u64) >> 48 & 3;
                d.product = S::new(self.product.get() << 2);
                (self.remainder.get() << 2 | next, self.quotient.get() << 2 | 1)
            }
            _ => (self.remainder.get() << 1 | 1, self.shifted.get() as u64),
        };
        let fits = left >= against;
        d.remainder = U::new(if fits { left - against } else { left });
        d.quotient = U::new(self.quotient.get() << 1 | u64::from(fits));
        if self.cycle == ADD {
            d.product = self.product;
            d.remainder = U::new(if op == Op::Root { 0 } else { (1 << 16) - 1 });
            d.quotient = U::new(0);
        }
        if op == Op::Root && self.cycle == ADD + 1 + ROOT_BITS {
            d.bits = U::new((10 + self.bits.get() + self.exponent.get() + self.odd()) / 2);
        }
    }

    /// The result, in the last cycle of an instruction.
    fn result(&self, now: &Instruction, p: &Params) -> Option<i64> {
        let cycles = match now.op {
            Op::Reciprocal => ADD + 1 + RECIPROCAL_BITS,
            Op::Root => ADD + 1 + ROOT_BITS,
            _ => ADD,
        };
        if self.cycle != cycles {
            return None;
        }
        if now.op != Op::Alu {
            return Some(self.quotient.get() as i64);
        }
        let (c, shifted) = (self.c.get(), self.shifted.get());
        let sum = if now.minus { c - shifted } else { c + shifted };
        let [least, most] = p.limits(now.clamp);
        Some(sum.clamp(least, most))
    }
}
