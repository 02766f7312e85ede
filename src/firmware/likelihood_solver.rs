//! The arithmetic between the passes of the likelihood estimator: a small machine with one multiplier.
//!
//! Mirrors `rtl_ref/likelihood_solver.v`. An instruction goes through nine cycles: operands, products with the low
//! 17 bits of `b` and with the others, their sum, two shifts, the sum with `c`, its limits, and the memory. Others begin
//! before, as far as they do not need what it gives: each says when the next one begins. A reciprocal takes 17 cycles
//! more, a root 25, a bit of each at a time. The programs are in [`program`]: the ambient light of a block, a point from the box, a step of
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
/// Bits of a magnitude that are not kept: a step is shifted if it has more of them, and the information if it has
/// two more.
const LEAST_MAGNITUDE: u32 = 14;
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
        /// First instruction of the program.
        pub entry: U<7>,
        /// Hits of the block that shows the ambient light.
        #[size(CountBits)]
        pub ambient_ended: Count,
        /// Its exposure [shots units].
        #[size(ExposureBits)]
        pub ambient_exposure: Exposure,
        /// The block is the only one.
        pub lone: bool,
        /// Excess of the highest box.
        #[size(ExcessBits)]
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
        /// Sum of the information on mu in the last pass.
        #[size(SlopeSumBits)]
        pub sum_11: S<48>,
        /// Sum of the information on mu and log S.
        #[size(SlopeSumBits)]
        pub sum_12: S<48>,
        /// Sum of the information on mu and log b.
        #[size(SlopeSumBits)]
        pub sum_13: S<48>,
        /// Sum of the information on log S.
        #[size(SumWordBits)]
        pub sum_22: S<43>,
        /// Sum of the information on log S and log b.
        #[size(SumWordBits)]
        pub sum_23: S<43>,
        /// Sum of the information on log b.
        #[size(SumWordBits)]
        pub sum_33: S<43>,
        /// Score of mu.
        #[size(SlopeSumBits)]
        pub score_1: S<48>,
        /// Score of log S.
        #[size(SumWordBits)]
        pub score_2: S<43>,
        /// Score of log b.
        #[size(SumWordBits)]
        pub score_3: S<43>,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Registers {
        /// A program has ended; one cycle.
        pub ran: bool,
        /// Arrival of the echo [units / 16].
        #[size(ArrivalBits)]
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
        /// Cycles until that one begins.
        pause: U<6>,
        /// There is an instruction in that cycle of it.
        at: [bool; 9],
        /// Number of the instruction in each cycle.
        number: [U<6>; 8],
        /// Location of the first operand.
        from_a: U<6>,
        /// Location of the second operand.
        from_b: U<6>,
        /// Location of the third operand.
        from_c: U<6>,
        /// By how many bits its product is shifted.
        base: U<5>,
        /// Addition to that shift, in the order of [`By`].
        by: U<3>,
        /// The instruction is neither a reciprocal nor a root.
        alu: bool,
        /// Location of the result.
        to: U<6>,
        /// Further property that is stored: 1 for the magnitude, 8 and more for the sign as a flag.
        mark: U<4>,
        /// Operands.
        #[size(WordBits)]
        a: Word,
        /// Second operand.
        #[size(WordBits)]
        b: Word,
        /// Third operand.
        #[size(WordBits)]
        c: Word,
        /// The low bits of a times those of b, or its others.
        #[size(LowTermBits)]
        low_product: S<46>,
        /// The others times that.
        #[size(HighTermBits)]
        high_product: S<56>,
        /// a times the low bits of b.
        #[size(LowProductBits)]
        low: S<63>,
        /// a times b.
        product: S<64>,
        /// By how many bits it is shifted.
        shift: U<6>,
        /// The low bits of that, a cycle later.
        shift_low: U<4>,
        /// The product after the longest shifts, with half of its lowest place.
        #[size(FineBits)]
        coarse: S<63>,
        /// Its sign.
        negative: bool,
        /// All bits that were left out equal the sign.
        coarse_fits: bool,
        /// The product as it is shifted, or a divisor.
        #[size(ShiftedBits)]
        shifted: S<47>,
        /// And half of its lowest place.
        half: bool,
        /// The product is beyond all limits, and only its sign is used.
        beyond: bool,
        /// The product is subtracted.
        minus: bool,
        /// The instruction is a reciprocal or a root.
        divides: bool,
        /// The instruction is a root.
        roots: bool,
        /// Sum of the product and c.
        #[size(SumOfWordBits)]
        sum: S<48>,
        /// The sum is beyond all limits.
        past: bool,
        /// On that side.
        opposite: bool,
        /// Its limits, in the order of [`Clamp`].
        limits: U<3>,
        /// Result of the instruction.
        #[size(WordBits)]
        result: Word,
        /// A reciprocal or a root is on the way.
        dividing: bool,
        /// The reciprocal or root has ended.
        divided: bool,
        /// Its next bit.
        digit: U<5>,
        /// Two bits that a root takes for its next bit.
        pair: U<2>,
        /// Bits of what was divided by last, or half of those of a variance.
        bits: U<6>,
        /// By how many bits the rest of the information is shifted.
        exponent: U<6>,
        /// All magnitudes that were marked, without their lowest 14 bits: on those no shift depends.
        #[size(MagnitudeBits)]
        magnitude: U<31>,
        /// Remainder of a division or a root.
        remainder: U<28>,
        /// Result of a division or a root.
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

/// Numbers of marks: a magnitude, and the first flag.
const MAGNITUDE: u64 = 1;
/// Number of the first flag.
const FLAGS: u64 = 8;
/// Bits of a reciprocal, and of a root.
const RECIPROCAL_BITS: u64 = 17;
/// Bits of a root.
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
    pub fn rests(&self, i: &In, p: &Params) -> bool {
        let still = !i.rst && !i.run && !self.registers.running && !self.registers.ran;
        still && {
            let mut next = *self;
            next.rise(i, p);
            next == *self
        }
    }

    /// The rising edge of `clk_sys`.
    pub fn rise(&mut self, i: &In, p: &Params) {
        let q = self.registers;
        let mut d = q;
        q.begin(i, &mut d);
        q.go_on(&mut d);
        self.fetch(i, p, &mut d);
        q.multiply(p, &mut d);
        q.shift(p, &mut d);
        q.add(p, &mut d);
        q.divide(&mut d);
        self.keep(i, &mut d);
        self.registers = if i.rst { Registers::default() } else { d };
    }

    /// Reads the operands; c comes late.
    fn fetch(&self, i: &In, p: &Params, d: &mut Registers) {
        let q = &self.registers;
        let word = |place: u8| match place.checked_sub(ONE) {
            Some(constant) => p.constants()[constant as usize],
            None => self.words[place as usize].get(),
        };
        let fit = |value: i64| S::new(wrapped(value, p.word_bits()));
        if q.at[0] {
            let (a, b) = (q.from_a.get() as u8, q.from_b.get() as u8);
            d.a = fit(i.first_operand(a).unwrap_or_else(|| word(a)));
            d.b = S::new(word(b));
        }
        if q.at[5] {
            let c = q.from_c.get() as u8;
            d.c = fit(i.third_operand(c).unwrap_or_else(|| word(c)));
            let now = q.instruction(5);
            (d.minus, d.divides, d.roots) = (now.minus, !q.alu, now.op == Op::Root);
        }
    }

    /// Writes a result.
    fn keep(&mut self, i: &In, d: &mut Registers) {
        let q = self.registers;
        if !q.at[8] {
            return;
        }
        let (to, result) = (q.to.get() as u8, q.result.get());
        match to {
            program::DEPTH => d.depth = S::new(result),
            program::SIGMA => d.sigma = U::new(result as u64),
            to => self.words[to as usize] = S::new(result),
        }
        match to {
            program::ARRIVAL => d.arrival = U::new(result as u64),
            program::SIGNAL => d.strength = U::new(result as u64),
            program::AMBIENT => d.ambient = U::new(result as u64),
            _ => {}
        }
        if q.mark == MAGNITUDE && !i.run && !q.measures() {
            let high = result.unsigned_abs() >> LEAST_MAGNITUDE;
            d.magnitude = U::new(q.magnitude.get() | high);
        }
        if let Some(flag) = q.mark.get().checked_sub(FLAGS) {
            let others = q.flags.get() & !(1 << flag);
            d.flags = U::new(others | u64::from(result < 0) << flag);
        }
    }
}

impl In {
    /// Returns the operand `a` if it comes from another block.
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

    /// Returns the operand `c` if it comes from another block.
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
    /// The instruction that is in a cycle.
    fn instruction(&self, cycle: usize) -> &'static Instruction {
        &PROGRAM[self.number[cycle].index()]
    }

    /// The next one.
    fn next_one(&self) -> &'static Instruction {
        &PROGRAM[self.counter.index() % PROGRAM.len()]
    }

    /// Returns whether an instruction begins.
    fn begins(&self) -> bool {
        self.running && self.pause == 0
    }

    /// Returns whether the marked values are measured.
    fn measures(&self) -> bool {
        self.begins() && matches!(self.next_one().op, Op::Exponent | Op::Cut)
    }

    /// Begins an instruction; one that measures is done at once.
    fn begin(&self, i: &In, d: &mut Self) {
        (d.ran, d.at[0]) = (false, false);
        if i.run {
            (d.running, d.counter, d.pause) = (true, i.entry, U::new(0));
            d.magnitude = U::new(0);
            return;
        }
        if !self.begins() {
            if self.running {
                d.pause = self.pause - 1;
            }
            return;
        }
        let now = self.next_one();
        d.pause = U::new(u64::from(now.wait) - 1);
        d.number[0] = U::new(self.counter.get());
        (d.from_a, d.from_b) = (U::new(now.a.into()), U::new(now.b.into()));
        match now.op {
            Op::End => (d.running, d.ran) = (false, true),
            _ => d.counter = self.counter + 1,
        }
        let bits = u64::from(length((self.magnitude.get() << LEAST_MAGNITUDE) as i64));
        match now.op {
            Op::Cut => d.cut = U::new(bits.saturating_sub(14)),
            Op::Exponent => d.exponent = U::new(bits.saturating_sub(16)),
            _ => {}
        }
        if self.measures() {
            d.magnitude = U::new(0);
        }
        d.at[0] = matches!(now.op, Op::Alu | Op::Reciprocal | Op::Root);
    }

    /// Moves instructions on; a reciprocal or a root waits until it has its bits.
    fn go_on(&self, d: &mut Self) {
        for cycle in 1..8 {
            d.number[cycle] = self.number[cycle - 1];
        }
        for cycle in 1..9 {
            d.at[cycle] = self.at[cycle - 1];
        }
        d.at[7] = self.at[6] && !self.divides;
        d.at[8] = self.at[7] || self.divided;
        if !self.at[6] {
            d.number[7] = self.number[7];
        }
        let now = self.instruction(2);
        (d.base, d.by) = (U::new(now.shift.into()), U::new(now.by as u64));
        let now = self.instruction(4);
        (d.from_c, d.alu) = (U::new(now.c.into()), now.op == Op::Alu);
        let now = self.instruction(7);
        d.to = U::new(now.to.into());
        d.mark = U::new(match now.mark {
            Mark::Nothing => 0,
            Mark::Magnitude => MAGNITUDE,
            Mark::Flag(flag) => FLAGS + u64::from(flag),
        });
    }

    /// The product.
    fn multiply(&self, p: &Params, d: &mut Self) {
        let (a, b, low) = (self.a.get(), self.b.get(), (1 << LOW_BITS) - 1);
        let part = if self.at[1] { b & low } else { b >> LOW_BITS };
        d.low_product = S::new((a & low) * part);
        d.high_product = S::new((a >> LOW_BITS) * part);
        let lower = self.low_product.get() + (self.low.get() >> LOW_BITS);
        let upper = self.high_product.get() + (lower >> LOW_BITS);
        let partial = upper.wrapping_shl(LOW_BITS) | lower & low;
        let size = p.word_bits() + 18;
        d.low = S::new(if self.at[2] { wrapped(partial, size) } else { 0 });
        if self.at[3] {
            let whole = partial.wrapping_shl(LOW_BITS) | self.low.get() & low;
            d.product = S::new(whole);
        }
        if self.at[1] && self.instruction(1).op == Op::Reciprocal {
            d.bits = U::new(length(a.max(1)).into());
        }
    }

    /// The product as the instruction shifts it; a divisor is not rounded.
    fn shift(&self, p: &Params, d: &mut Self) {
        let by = match By::ALL[self.by.index() % By::ALL.len()] {
            By::Nothing => 0,
            By::Bits => self.bits.get(),
            By::Exponent => self.exponent.get(),
            By::Cut => self.cut.get(),
            By::Both => self.bits.get() + self.exponent.get(),
            By::Metres => p.metres_shift.into(),
        };
        d.shift = U::new((self.base.get() + by).min(63));
        d.shift_low = U::new(self.shift.get() & 15);

        let width = p.word_bits() + 2;
        let down = (i128::from(self.product.get()) << 1) >> (self.shift.get() & 48);
        let most = 1 << (width + 15);
        d.coarse = S::new(wrapped(down as i64, width + 16));
        d.negative = down < 0;
        d.coarse_fits = (-most..most).contains(&down);
        if !self.at[5] {
            return;
        }
        let fine = self.coarse.get() >> self.shift_low.get();
        let sign = if self.negative { -(1 << (width - 1)) } else { 0 };
        d.shifted = S::new(sign + (fine >> 1 & ((1 << (width - 1)) - 1)));
        d.half = fine & 1 != 0 && self.alu;
        // One place is left for the rounding.
        let most = 1 << (width - 1);
        let same = (fine < 0) == self.negative;
        d.beyond = !(self.coarse_fits && same && (-most..most).contains(&fine));
    }

    /// The sum, and its limits.
    fn add(&self, p: &Params, d: &mut Self) {
        let (c, shifted) = (self.c.get(), self.shifted.get() + i64::from(self.half));
        d.sum = S::new(if self.minus { c - shifted } else { c + shifted });
        (d.past, d.opposite) = (self.beyond, (self.shifted.get() < 0) != self.minus);
        d.limits = U::new(self.instruction(6).clamp as u64);

        let [least, most] = p.limits(Clamp::ALL[self.limits.index()]);
        d.result = S::new(match (self.divided, self.past, self.opposite) {
            (true, ..) => self.quotient.get() as i64,
            (_, true, true) => least,
            (_, true, false) => most,
            _ => self.sum.get().clamp(least, most),
        });
    }

    /// Whether a variance's exponent is odd.
    fn odd(&self) -> u64 {
        (self.bits.get() + self.exponent.get()) & 1
    }

    /// A bit of a reciprocal or of a root, which takes two bits of the product each time.
    fn divide(&self, d: &mut Self) {
        let last = self.digit == if self.roots { ROOT_BITS } else { RECIPROCAL_BITS };
        d.dividing = self.at[6] && self.divides || self.dividing && !last;
        d.divided = self.dividing && last;
        if self.divided && self.roots {
            d.bits = U::new((10 + self.bits.get() + self.exponent.get() + self.odd()) / 2);
        }
        let pairs = (self.product.get() as u64 & ((1 << 34) - 1)) << self.odd();
        d.pair = U::new(pairs.checked_shl(2 * self.digit.get() as u32).unwrap_or(0) >> 32);
        d.digit = U::new(match (self.at[6], self.dividing) {
            (true, _) => 1,
            (_, true) => self.digit.get() + 1,
            _ => 0,
        });
        if self.at[6] {
            d.remainder = U::new(if self.roots { 0 } else { (1 << 16) - 1 });
            d.quotient = U::new(0);
            return;
        }
        if !self.dividing {
            return;
        }
        let (left, against) = match self.roots {
            true => (self.remainder.get() << 2 | self.pair.get(), self.quotient.get() << 2 | 1),
            false => {
                let divisor = self.shifted.get() as u64 & U::<28>::MAX.get();
                (self.remainder.get() << 1 | 1, divisor)
            }
        };
        let left = U::<28>::new(left).get();
        let fits = left >= against;
        d.remainder = U::new(if fits { left - against } else { left });
        d.quotient = U::new(self.quotient.get() << 1 | u64::from(fits));
    }
}
