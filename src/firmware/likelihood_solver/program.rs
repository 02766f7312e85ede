//! The solver's program, instruction by instruction; `solver.mem` has it for the Verilog.

use std::sync::LazyLock;

use crate::firmware::likelihood_estimator::params::Params;

use super::instruction::{By, Clamp, Instruction, Mark, Op};

/// Words of the solver's memory; from [`ONE`] on they are constants.
pub const ARRIVAL: u8 = 0;
/// S.
pub const SIGNAL: u8 = 1;
/// b.
pub const AMBIENT: u8 = 2;
const F1: u8 = 3;
const F2: u8 = 4;
const F3: u8 = 5;
const A11: u8 = 6;
const A12: u8 = 7;
const A22: u8 = 8;
const X1: u8 = 9;
const X2: u8 = 10;
const DET: u8 = 11;
const N1: u8 = 12;
const N2: u8 = 13;
const D1: u8 = 14;
const D2: u8 = 15;
const T: u8 = 16;
const R: u8 = 17;
/// The first constant.
pub const ONE: u8 = 18;
const KAPPA: u8 = 19;
const STRIDE: u8 = 20;
const METRES: u8 = 21;
const THIRD: u8 = 22;
const NINETEEN: u8 = 23;
const POWER: u8 = 24;
const ZERO: u8 = 25;
const WIDE: u8 = 26;
const MARGIN: u8 = 27;
const END: u8 = 28;
const VARIANCE: u8 = 29;
const UNSURE: u8 = 30;
const TWO: u8 = 31;

/// Operands from other blocks: of `a` ..
const SUM_13: u8 = 32;
const SUM_23: u8 = 33;
const SUM_33: u8 = 34;
const SCORE_3: u8 = 35;
const ENDED: u8 = 36;
const EXPOSURE: u8 = 37;
const EXCESS: u8 = 38;
const MIDDLE: u8 = 39;
const LENGTH: u8 = 40;
const BOX: u8 = 41;
const SCORE_4: u8 = 43;
const SUM_14: u8 = 44;
const SUM_24: u8 = 45;
const SUM_34: u8 = 46;
const SUM_44: u8 = 47;
/// .. and of `c`.
const SUM_11: u8 = 32;
const SUM_12: u8 = 33;
const SUM_22: u8 = 34;
const SCORE_1: u8 = 35;
const SCORE_2: u8 = 36;
const OTHER_13: u8 = 40;
const OTHER_23: u8 = 41;
const OTHER_33: u8 = 42;
const OTHER_SCORE_3: u8 = 43;

/// Location of the depth.
pub const DEPTH: u8 = 32;
/// Location of sigma.
pub const SIGMA: u8 = 33;

/// The cover glass's light C, behind the operands from other blocks, as what follows.
pub const GLASS: u8 = 48;
/// C when it was calibrated.
pub const CALIBRATED: u8 = 49;
const G1: u8 = 50;
const G2: u8 = 51;
const G3: u8 = 52;
const G4: u8 = 53;
const A13: u8 = 54;
const A23: u8 = 55;
/// Information on log b that is left without log C.
pub const A33: u8 = 56;
const Y3: u8 = 57;

/// Cycles that the multiplier takes for a product.
const MULTIPLIED: u8 = 2;
/// Cycles from an instruction to one that has its result as `a` or `b`, or as `c`.
const LATENCY: u64 = 9;
const LATE: u64 = 4;
/// The same where the result is a reciprocal or a root.
const RECIPROCAL_LATENCY: u64 = 26;
const ROOT_LATENCY: u64 = 34;
/// Cycles from an instruction whose magnitude is marked to its measure.
const MARKED: u64 = 10;

/// Returns whether a place is a word of the solver, which all but operands from other blocks are.
pub fn is_own(place: u8) -> bool {
    place < 32 || place >= 48
}

/// to = a b >> shift.
const fn times(to: u8, a: u8, b: u8, shift: u8) -> Instruction {
    let (op, by, clamp, mark) = (Op::Alu, By::Nothing, Clamp::Word, Mark::Nothing);
    Instruction { op, to, a, b, c: ZERO, minus: false, shift, by, clamp, mark, wait: MULTIPLIED }
}

impl Instruction {
    const fn plus(self, c: u8) -> Self {
        Instruction { c, ..self }
    }

    const fn from(self, c: u8) -> Self {
        Instruction { c, minus: true, ..self }
    }

    const fn by(self, by: By) -> Self {
        Instruction { by, ..self }
    }

    const fn clamp(self, clamp: Clamp) -> Self {
        Instruction { clamp, ..self }
    }

    const fn large(self) -> Self {
        Instruction { mark: Mark::Magnitude, ..self }
    }

    const fn flag(self, flag: u8) -> Self {
        Instruction { mark: Mark::Flag(flag), ..self }
    }

    const fn op(self, op: Op) -> Self {
        Instruction { op, ..self }
    }
}

/// Reciprocal of `a`.
const fn over(a: u8) -> Instruction {
    times(R, a, POWER, 0).op(Op::Reciprocal).by(By::Bits)
}

/// An instruction without operands: `exponent` or `cut` from what has been marked, or the end.
const fn measure(op: Op) -> Instruction {
    Instruction { wait: 1, ..times(ZERO, ZERO, ZERO, 0).op(op) }
}

const END_OF_PROGRAM: Instruction = measure(Op::End);

/// A program for each of the estimator's tasks, one after the other in the ROM.
#[derive(Clone, Debug)]
pub struct Program {
    /// All instructions.
    pub instructions: Vec<Instruction>,
    /// First instruction of the program for the ambient light.
    pub ambient: u64,
    /// From the box to a point.
    pub start: u64,
    /// A step of Fisher scoring.
    pub step: u64,
    /// Depth, deviation and flags.
    pub end: u64,
}

/// The programs of an estimator that knows of no cover glass.
static USUAL: LazyLock<Program> = LazyLock::new(|| {
    let step = [&ELIMINATION[..], &SOLUTION].concat();
    Program::new([AMBIENT_LIGHT.to_vec(), START.to_vec(), step, END_RESULTS.to_vec()])
});

/// Those of one that does.
static WITH_GLASS: LazyLock<Program> = LazyLock::new(|| {
    let ambient = [&AMBIENT_LIGHT[..], &[times(GLASS, CALIBRATED, ONE, 0)]].concat();
    let step = [&GLASS_ELIMINATION[..], &SOLUTION, &GLASS_STEP].concat();
    Program::new([ambient, START.to_vec(), step, END_RESULTS.to_vec()])
});

impl Params {
    /// The solver's programs.
    pub fn program(&self) -> &'static Program {
        Program::of(self.glass.bins() > 0)
    }
}

/// The chance of a bin, and -log(1 - chance) to the third power.
const AMBIENT_LIGHT: [Instruction; 6] = [
    over(EXPOSURE),
    times(T, ENDED, R, 2).by(By::Bits).clamp(Clamp::Chance),
    times(X1, T, T, 24),
    times(X2, X1, T, 24),
    times(T, X1, ONE, 1).plus(T),
    times(AMBIENT, X2, THIRD, 10).plus(T).clamp(Clamp::Ambient),
];

/// Where the box stands highest, and how high.
const START: [Instruction; 5] = [
    over(MIDDLE),
    times(T, EXCESS, R, 0).by(By::Bits),
    times(T, LENGTH, T, 13),
    times(ARRIVAL, BOX, ONE, 0),
    times(SIGNAL, T, NINETEEN, 4).clamp(Clamp::Signal),
];

/// Elimination of log b.
const ELIMINATION: [Instruction; 9] = [
    over(SUM_33),
    times(F1, SUM_13, R, 2).by(By::Bits),
    times(F2, SUM_23, R, 2).by(By::Bits),
    times(F3, SCORE_3, R, 2).by(By::Bits),
    times(A11, SUM_13, F1, 14).from(SUM_11).clamp(Clamp::Positive).large(),
    times(A12, SUM_23, F1, 14).from(SUM_12),
    times(A22, SUM_23, F2, 14).from(SUM_22).clamp(Clamp::Positive).large(),
    times(X1, SCORE_3, F1, 14).from(SCORE_1).large(),
    times(X2, SCORE_3, F2, 14).from(SCORE_2).large(),
];

/// Elimination of log C, then of log b.
const GLASS_ELIMINATION: [Instruction; 23] = [
    over(SUM_44),
    times(G1, SUM_14, R, 2).by(By::Bits),
    times(G2, SUM_24, R, 2).by(By::Bits),
    times(G3, SUM_34, R, 2).by(By::Bits),
    times(G4, SCORE_4, R, 2).by(By::Bits),
    times(A33, SUM_34, G3, 14).from(OTHER_33).clamp(Clamp::Positive),
    times(A13, SUM_34, G1, 14).from(OTHER_13),
    times(A23, SUM_34, G2, 14).from(OTHER_23),
    times(Y3, SCORE_4, G3, 14).from(OTHER_SCORE_3),
    times(A11, SUM_14, G1, 14).from(SUM_11),
    times(A12, SUM_24, G1, 14).from(SUM_12),
    times(A22, SUM_24, G2, 14).from(SUM_22),
    times(X1, SCORE_4, G1, 14).from(SCORE_1),
    times(X2, SCORE_4, G2, 14).from(SCORE_2),
    over(A33),
    times(F1, A13, R, 2).by(By::Bits),
    times(F2, A23, R, 2).by(By::Bits),
    times(F3, Y3, R, 2).by(By::Bits),
    times(A11, A13, F1, 14).from(A11).clamp(Clamp::Positive).large(),
    times(A12, A23, F1, 14).from(A12),
    times(A22, A23, F2, 14).from(A22).clamp(Clamp::Positive).large(),
    times(X1, Y3, F1, 14).from(X1).large(),
    times(X2, Y3, F2, 14).from(X2).large(),
];

/// The rest is shifted to 16 bits, and solved by Cramer's rule.
const SOLUTION: [Instruction; 26] = [
    measure(Op::Exponent),
    times(A11, A11, ONE, 0).by(By::Exponent),
    times(A22, A22, ONE, 0).by(By::Exponent),
    times(A12, A12, ONE, 0).by(By::Exponent),
    times(X1, X1, ONE, 0).by(By::Exponent),
    times(X2, X2, ONE, 0).by(By::Exponent),
    times(DET, A11, A22, 0),
    times(DET, A12, A12, 0).from(DET).clamp(Clamp::Positive),
    times(N1, A22, X1, 0),
    times(N1, A12, X2, 0).from(N1),
    times(N2, A11, X2, 0),
    times(N2, A12, X1, 0).from(N2),
    over(DET),
    times(D1, N1, R, 2).by(By::Bits),
    times(D2, N2, R, 2).by(By::Bits).large(),
    times(T, D1, KAPPA, 14).large(),
    measure(Op::Cut),
    times(D1, D1, ONE, 0).by(By::Cut),
    times(D2, D2, ONE, 0).by(By::Cut),
    times(T, F1, D1, 14).from(F3),
    times(X1, D1, STRIDE, 17),
    times(X2, D2, D2, 15).plus(D2),
    times(T, F2, D2, 14).from(T).clamp(Clamp::Growth),
    times(ARRIVAL, X1, ONE, 0).plus(ARRIVAL).clamp(Clamp::Window),
    times(SIGNAL, SIGNAL, X2, 14).plus(SIGNAL).clamp(Clamp::Signal),
    times(AMBIENT, AMBIENT, T, 14).plus(AMBIENT).clamp(Clamp::Ambient),
];

/// The step of log C: its own, beside that of log b.
const GLASS_STEP: [Instruction; 5] = [
    times(N1, G1, D1, 14).from(G4),
    times(N1, G2, D2, 14).from(N1),
    times(N1, G3, T, 14).from(N1),
    times(N1, T, ONE, 0).plus(N1).clamp(Clamp::Change),
    times(GLASS, GLASS, N1, 14).plus(GLASS).clamp(Clamp::Signal),
];

/// Flags 0 and 1: log S is not known to a quarter, to a fifth; 2: nor mu to the pulse's deviation; 3 and 4: next to the
/// begin or the end of the window; 5 and 6: the last step was long. Depth and deviation.
const END_RESULTS: [Instruction; 14] = [
    times(N1, A11, R, 0).by(By::Both),
    times(N2, A22, R, 0).op(Op::Root),
    times(T, N1, ONE, 0).from(VARIANCE).flag(0),
    times(T, N1, ONE, 0).from(UNSURE).flag(1),
    times(N2, N2, STRIDE, 11).by(By::Bits),
    times(T, MARGIN, ONE, 0).from(ARRIVAL).flag(3),
    times(T, ARRIVAL, ONE, 0).from(END),
    times(T, MARGIN, ONE, 0).from(T).flag(4),
    times(T, N2, ONE, 0).from(WIDE).flag(2),
    times(T, N2, TWO, 0).plus(X1).flag(5),
    times(X1, X1, ONE, 0).from(ZERO),
    times(T, N2, TWO, 0).plus(X1).flag(6),
    times(DEPTH, ARRIVAL, METRES, 0).by(By::Metres),
    times(SIGMA, N2, METRES, 0).by(By::Metres),
];

impl Program {
    /// Returns the programs of an estimator that knows of a cover glass, or of none.
    pub fn of(has_glass: bool) -> &'static Self {
        if has_glass { &WITH_GLASS } else { &USUAL }
    }

    /// Puts programs one after the other, each with the waits that its operands need.
    fn new(programs: [Vec<Instruction>; 4]) -> Self {
        let mut instructions = Vec::new();
        let [ambient, start, step, end] = programs.map(|mut program| {
            let entry = instructions.len() as u64;
            program.push(END_OF_PROGRAM);
            schedule(&mut program);
            instructions.append(&mut program);
            entry
        });
        Program { instructions, ambient, start, step, end }
    }

    /// From the cycle that begins a program to the one in which it has ended, both counted [cycles of clk_sys].
    pub fn cycles(&self, entry: u64) -> u64 {
        let instructions = self.instructions[entry as usize..].iter();
        let instructions = instructions.take_while(|instruction| instruction.op != Op::End);
        instructions.map(|instruction| u64::from(instruction.wait)).sum::<u64>() + 3
    }
}

/// Lets each instruction begin as soon as it has its operands.
fn schedule(program: &mut [Instruction]) {
    let mut schedule = Schedule::default();
    for place in 0..program.len() {
        let begin = schedule.earliest(&program[place]);
        if let Some(last) = place.checked_sub(1) {
            program[last].wait += (begin - schedule.now) as u8;
        }
        schedule.begin(&program[place], begin);
    }
}

/// When results are there, in cycles from the begin of a program.
struct Schedule {
    /// The earliest cycle for the next instruction.
    now: u64,
    /// When a word can be the operand `a` or `b`.
    ready: [u64; 64],
    /// When all marked magnitudes are there.
    marked: u64,
    /// When the last reciprocal or root has ended.
    divided: u64,
}

impl Default for Schedule {
    fn default() -> Self {
        Schedule { now: 0, ready: [0; 64], marked: 0, divided: 0 }
    }
}

impl Schedule {
    /// The first cycle in which an instruction has its operands.
    fn earliest(&self, instruction: &Instruction) -> u64 {
        let own = |place: u8| if is_own(place) { self.ready[place as usize] } else { 0 };
        let Instruction { a, b, c, .. } = *instruction;
        let operands = match instruction.op {
            Op::End => self.ready.into_iter().max().unwrap_or(0),
            Op::Exponent | Op::Cut => self.marked,
            _ => own(a).max(own(b)).max(self.divided).max(own(c).saturating_sub(LATENCY - LATE)),
        };
        operands.max(self.now)
    }

    /// Begins an instruction.
    fn begin(&mut self, instruction: &Instruction, begin: u64) {
        let latency = match instruction.op {
            Op::Reciprocal => RECIPROCAL_LATENCY,
            Op::Root => ROOT_LATENCY,
            _ => LATENCY,
        };
        if !matches!(instruction.op, Op::Exponent | Op::Cut | Op::End) {
            self.ready[instruction.to as usize] = begin + latency;
        }
        if instruction.mark == Mark::Magnitude {
            self.marked = begin + MARKED;
        }
        if latency > LATENCY {
            self.divided = begin + latency;
        }
        self.now = begin + u64::from(instruction.wait);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_programs_are_as_long_as_the_operands_need() {
        let cycles = |program: &Program| {
            let Program { ambient, start, step, end, .. } = *program;
            [ambient, start, step, end].map(|entry| program.cycles(entry))
        };
        assert_eq!(cycles(&USUAL), [65, 56, 165, 74]);
        assert_eq!(USUAL.instructions.len(), 64);
        assert_eq!(cycles(&WITH_GLASS), [67, 56, 245, 74]);
    }
}
