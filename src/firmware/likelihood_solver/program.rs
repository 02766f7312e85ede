//! The solver's program, instruction by instruction; `solver.mem` has it for the Verilog.

use std::sync::LazyLock;

use crate::firmware::likelihood_estimator::params::Params;

use super::instruction::{By, Clamp, Instruction, Mark, Op};
use super::places::*;
use super::schedule::schedule;

/// Cycles that the multiplier takes for a product.
const MULTIPLIED: u8 = 2;
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
    /// From the box to the other echo.
    pub second: u64,
    /// The echoes in each other's place.
    pub swap: u64,
}

/// The programs of an estimator that knows of no cover glass and of one target.
static USUAL: LazyLock<Program> = LazyLock::new(|| Program::new(usual()));

/// Those of one that knows of a cover glass.
static WITH_GLASS: LazyLock<Program> = LazyLock::new(|| Program::new(with_glass()));

/// Those of one that looks for a second target.
static WITH_SECOND: LazyLock<Program> =
    LazyLock::new(|| Program::new(usual().into_iter().chain(for_second())));

/// Those of one that does both.
static WITH_BOTH: LazyLock<Program> =
    LazyLock::new(|| Program::new(with_glass().into_iter().chain(for_second())));

/// Ambient light, the start, a step and the results.
fn usual() -> [Vec<Instruction>; 4] {
    let step = [&ELIMINATION[..], &SOLUTION].concat();
    [AMBIENT_LIGHT.to_vec(), START.to_vec(), step, END_RESULTS.to_vec()]
}

/// The same with a cover glass.
fn with_glass() -> [Vec<Instruction>; 4] {
    let ambient = [&AMBIENT_LIGHT[..], &[times(GLASS, CALIBRATED, ONE, 0)]].concat();
    let step = [&GLASS_ELIMINATION[..], &SOLUTION, &GLASS_STEP].concat();
    [ambient, START.to_vec(), step, END_RESULTS.to_vec()]
}

/// The start of a second echo, and what puts the echoes in each other's place.
fn for_second() -> [Vec<Instruction>; 2] {
    [SECOND.to_vec(), SWAP.to_vec()]
}

impl Params {
    /// The solver's programs.
    pub fn program(&self) -> &'static Program {
        Program::of(self.glass.bins() > 0, self.has_second())
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

/// The same for the other echo.
const SECOND: [Instruction; 5] = [
    over(MIDDLE),
    times(T, EXCESS, R, 0).by(By::Bits),
    times(T, LENGTH, T, 13),
    times(OTHER_ARRIVAL, BOX, ONE, 0),
    times(OTHER_SIGNAL, T, NINETEEN, 4).clamp(Clamp::Signal),
];

/// The echoes in each other's place.
const SWAP: [Instruction; 6] = [
    times(T, ARRIVAL, ONE, 0),
    times(N1, SIGNAL, ONE, 0),
    times(ARRIVAL, OTHER_ARRIVAL, ONE, 0),
    times(SIGNAL, OTHER_SIGNAL, ONE, 0),
    times(OTHER_ARRIVAL, T, ONE, 0),
    times(OTHER_SIGNAL, N1, ONE, 0),
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
    /// Returns the programs of an estimator that knows of a cover glass, or of none, and looks for a second target, or
    /// does not.
    pub fn of(has_glass: bool, has_second: bool) -> &'static Self {
        match (has_glass, has_second) {
            (false, false) => &USUAL,
            (true, false) => &WITH_GLASS,
            (false, true) => &WITH_SECOND,
            (true, true) => &WITH_BOTH,
        }
    }

    /// Puts programs one after the other, each with the waits that its operands need.
    fn new(programs: impl IntoIterator<Item = Vec<Instruction>>) -> Self {
        let mut instructions = Vec::new();
        let mut entries = [0; 6];
        for (entry, mut program) in entries.iter_mut().zip(programs) {
            *entry = instructions.len() as u64;
            program.push(END_OF_PROGRAM);
            schedule(&mut program);
            instructions.append(&mut program);
        }
        let [ambient, start, step, end, second, swap] = entries;
        Program { instructions, ambient, start, step, end, second, swap }
    }

    /// From the cycle that begins a program to the one in which it has ended, both counted [cycles of clk_sys].
    pub fn cycles(&self, entry: u64) -> u64 {
        let instructions = self.instructions[entry as usize..].iter();
        let instructions = instructions.take_while(|instruction| instruction.op != Op::End);
        instructions.map(|instruction| u64::from(instruction.wait)).sum::<u64>() + 3
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
        for (program, alone) in [(&WITH_SECOND, &USUAL), (&WITH_BOTH, &WITH_GLASS)] {
            assert_eq!(cycles(program), cycles(alone));
            assert_eq!(program.second as usize, alone.instructions.len());
            let of_second = [program.second, program.swap].map(|entry| program.cycles(entry));
            assert_eq!(of_second, [56, 23]);
        }
        assert_eq!([&WITH_SECOND, &WITH_BOTH].map(|program| program.instructions.len()), [77, 97]);
    }
}
