//! The arithmetic between the passes of the likelihood estimator: a small machine with one multiplier.
//!
//! Mirrors `rtl_ref/likelihood_solver.v`. An instruction goes through nine cycles: operands, products with the low
//! 17 bits of `b` and with the others, their sum, two shifts, the sum with `c`, its limits, and the memory. Others begin
//! before, as far as they do not need what it gives: each says when the next one begins. A reciprocal takes 17 cycles
//! more, a root 25, a bit of each at a time. The programs are in [`program`], and from there in the ROM: the ambient light of a block, a point
//! from the box, a step of Fisher scoring, and what comes out at the end.
//!
//! `sequence` begins instructions and moves them on, `operands` reads and writes words, and between the two are
//! `arithmetic` and `division`.

use crate::kernel::{S, U};
use crate::{module_of_registers, signals};

use super::histogram_builder::Count;
use super::likelihood_estimator::params::Params;
use super::likelihood_estimator::words::SCARCE;
use super::likelihood_memory::{Exposure, Place};
use super::likelihood_scan::Excess;

mod arithmetic;
mod division;
pub mod instruction;
mod operands;
mod places;
pub mod program;
mod schedule;
mod sequence;

/// A word of the memory, and the most bits of one.
pub type Word = S<45>;
/// Words of the memory, with the places of operands from other blocks.
const WORDS: usize = 64;
/// Bits of `b` that the multiplier takes first.
const LOW_BITS: u32 = 17;
/// Bits of a magnitude that are not kept: a step is shifted if it has more of them, and the information if it has
/// two more.
const LEAST_MAGNITUDE: u32 = 14;

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
        /// Sum of the information on mu and log C.
        #[only_if(Glass)]
        #[size(SlopeSumBits)]
        pub sum_14: S<48>,
        /// Sum of the information on log S and log C.
        #[only_if(Glass)]
        #[size(SumWordBits)]
        pub sum_24: S<43>,
        /// Sum of the information on log b and log C.
        #[only_if(Glass)]
        #[size(SumWordBits)]
        pub sum_34: S<43>,
        /// Sum of the information on log C.
        #[only_if(Glass)]
        #[size(SumWordBits)]
        pub sum_44: S<43>,
        /// Score of log C.
        #[only_if(Glass)]
        #[size(SumWordBits)]
        pub score_4: S<43>,
        /// Both echoes have light.
        #[only_if(HasSecond)]
        pub paired: bool,
        /// Sum of the information on mu and log b beside another echo.
        #[only_if(HasSecond)]
        #[size(SlopeSumBits)]
        pub still_13: S<48>,
        /// Sum of the information on log S and log b beside another echo.
        #[only_if(HasSecond)]
        #[size(SumWordBits)]
        pub still_23: S<43>,
        /// Sum of the information on log b beside another echo.
        #[only_if(HasSecond)]
        #[size(SumWordBits)]
        pub still_33: S<43>,
        /// Score of log b beside another echo.
        #[only_if(HasSecond)]
        #[size(SumWordBits)]
        pub still_score: S<43>,
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
        /// C, 14 fraction bits [photons a shot].
        #[only_if(Glass)]
        pub glass: U<24>,
        /// Arrival of the other echo [units / 16].
        #[only_if(HasSecond)]
        #[size(ArrivalBits)]
        #[view(heading = "Likelihood", probe = true)]
        pub other_arrival: U<21>,
        /// S of the other echo, 14 fraction bits [photons a shot].
        #[only_if(HasSecond)]
        #[view(heading = "Likelihood", probe = true)]
        pub other_strength: U<24>,
        /// Depth of the last end program [2^-29 m].
        pub depth: S<36, 29>,
        /// Its deviation [2^-29 m].
        pub sigma: U<36>,
        /// Flags of the last end program.
        pub flags: U<7>,
        /// By how many bits the last step was shortened.
        pub cut: U<6>,
        /// Little is known of log b.
        scarce: bool,
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
        #[size(ProgramBits)]
        number: [U<7>; 8],
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

module_of_registers!(LikelihoodSolver);

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
        if p.glass.bins() == 0 {
            d.scarce = i.on_ambient().2 < SCARCE;
        }
        q.begin(i, p, &mut d);
        q.go_on(p, &mut d);
        self.fetch(i, p, &mut d);
        q.multiply(p, &mut d);
        q.shift(p, &mut d);
        q.add(p, &mut d);
        q.divide(&mut d);
        self.keep(i, p, &mut d);
        self.registers = if i.rst { Registers::default() } else { d };
    }
}
