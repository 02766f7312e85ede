//! The solver's program, instruction by instruction; `solver.mem` has it for the Verilog.

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
/// .. and of `c`.
const SUM_11: u8 = 32;
const SUM_12: u8 = 33;
const SUM_22: u8 = 34;
const SCORE_1: u8 = 35;
const SCORE_2: u8 = 36;

/// Location of the depth.
pub const DEPTH: u8 = 32;
/// Location of sigma.
pub const SIGMA: u8 = 33;

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

    const fn wait(self, wait: u8) -> Self {
        Instruction { wait, ..self }
    }

    const fn op(self, op: Op) -> Self {
        Instruction { op, ..self }
    }
}

/// Reciprocal of `a`.
const fn over(a: u8) -> Instruction {
    times(R, a, POWER, 0).op(Op::Reciprocal).by(By::Bits)
}

/// `exponent` or `cut` from what has been marked.
const fn measure(op: Op) -> Instruction {
    times(ZERO, ZERO, ZERO, 0).op(op).wait(1)
}

const END_OF_PROGRAM: Instruction = times(ZERO, ZERO, ZERO, 0).op(Op::End).wait(1);

/// First instruction of the program for the ambient light.
pub const AMBIENT_PROGRAM: u64 = 0;
/// From the box to a point.
pub const START_PROGRAM: u64 = 7;
/// A step of Fisher scoring.
pub const STEP_PROGRAM: u64 = 13;
/// Depth, deviation and flags.
pub const END_PROGRAM: u64 = 49;

/// All programs.
pub const PROGRAM: [Instruction; 64] = [
    // The chance of a bin, and -log(1 - chance) to the third power.
    over(EXPOSURE).wait(26),
    times(T, ENDED, R, 2).by(By::Bits).clamp(Clamp::Chance).wait(9),
    times(X1, T, T, 24).wait(9),
    times(X2, X1, T, 24),
    times(T, X1, ONE, 1).plus(T).wait(7),
    times(AMBIENT, X2, THIRD, 10).plus(T).clamp(Clamp::Ambient).wait(9),
    END_OF_PROGRAM,
    // Where the box stands highest, and how high.
    over(MIDDLE).wait(26),
    times(T, EXCESS, R, 0).by(By::Bits).wait(9),
    times(T, LENGTH, T, 13),
    times(ARRIVAL, BOX, ONE, 0).wait(7),
    times(SIGNAL, T, NINETEEN, 4).clamp(Clamp::Signal).wait(9),
    END_OF_PROGRAM,
    // log b is eliminated.
    over(SUM_33).wait(26),
    times(F1, SUM_13, R, 2).by(By::Bits),
    times(F2, SUM_23, R, 2).by(By::Bits),
    times(F3, SCORE_3, R, 2).by(By::Bits).wait(5),
    times(A11, SUM_13, F1, 14).from(SUM_11).clamp(Clamp::Positive).large(),
    times(A12, SUM_23, F1, 14).from(SUM_12),
    times(A22, SUM_23, F2, 14).from(SUM_22).clamp(Clamp::Positive).large(),
    times(X1, SCORE_3, F1, 14).from(SCORE_1).large(),
    times(X2, SCORE_3, F2, 14).from(SCORE_2).large().wait(10),
    // The rest is shifted to 16 bits, and solved by Cramer's rule.
    measure(Op::Exponent),
    times(A11, A11, ONE, 0).by(By::Exponent),
    times(A22, A22, ONE, 0).by(By::Exponent),
    times(A12, A12, ONE, 0).by(By::Exponent),
    times(X1, X1, ONE, 0).by(By::Exponent),
    times(X2, X2, ONE, 0).by(By::Exponent).wait(3),
    times(DET, A11, A22, 0).wait(4),
    times(DET, A12, A12, 0).from(DET).clamp(Clamp::Positive),
    times(N1, A22, X1, 0).wait(4),
    times(N1, A12, X2, 0).from(N1),
    times(N2, A11, X2, 0).wait(4),
    times(N2, A12, X1, 0).from(N2),
    over(DET).wait(26),
    times(D1, N1, R, 2).by(By::Bits),
    times(D2, N2, R, 2).by(By::Bits).large().wait(7),
    times(T, D1, KAPPA, 14).large().wait(10),
    measure(Op::Cut),
    times(D1, D1, ONE, 0).by(By::Cut),
    times(D2, D2, ONE, 0).by(By::Cut).wait(7),
    times(T, F1, D1, 14).from(F3),
    times(X1, D1, STRIDE, 17),
    times(X2, D2, D2, 15).plus(D2),
    times(T, F2, D2, 14).from(T).clamp(Clamp::Growth).wait(5),
    times(ARRIVAL, X1, ONE, 0).plus(ARRIVAL).clamp(Clamp::Window),
    times(SIGNAL, SIGNAL, X2, 14).plus(SIGNAL).clamp(Clamp::Signal),
    times(AMBIENT, AMBIENT, T, 14).plus(AMBIENT).clamp(Clamp::Ambient).wait(9),
    END_OF_PROGRAM,
    // Flags 0 and 1: log S is not known to a quarter, to a fifth; 2: nor mu to the pulse's deviation.
    times(N1, A11, R, 0).by(By::Both),
    times(N2, A22, R, 0).op(Op::Root).wait(34),
    times(T, N1, ONE, 0).from(VARIANCE).flag(0),
    times(T, N1, ONE, 0).from(UNSURE).flag(1),
    times(N2, N2, STRIDE, 11).by(By::Bits),
    // Flags 3 and 4: next to the begin or the end of the window; 5 and 6: the last step was long.
    times(T, MARGIN, ONE, 0).from(ARRIVAL).flag(3),
    times(T, ARRIVAL, ONE, 0).from(END).wait(4),
    times(T, MARGIN, ONE, 0).from(T).flag(4),
    times(T, N2, ONE, 0).from(WIDE).flag(2),
    times(T, N2, TWO, 0).plus(X1).flag(5),
    times(X1, X1, ONE, 0).from(ZERO).wait(4),
    times(T, N2, TWO, 0).plus(X1).flag(6),
    times(DEPTH, ARRIVAL, METRES, 0).by(By::Metres),
    times(SIGMA, N2, METRES, 0).by(By::Metres).wait(9),
    END_OF_PROGRAM,
];

/// From the cycle that begins a program to the one in which it has ended, both counted [cycles of clk_sys].
pub fn program_cycles(entry: u64) -> u64 {
    let instructions = PROGRAM[entry as usize..].iter();
    let instructions = instructions.take_while(|instruction| instruction.op != Op::End);
    instructions.map(|instruction| u64::from(instruction.wait)).sum::<u64>() + 3
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cycles from an instruction to one that has its result as `a` or `b`, as `c`, or in a measure.
    const LATENCY: u64 = 9;
    const LATE: u64 = 4;
    const MARKED: u64 = 10;

    #[test]
    fn no_instruction_begins_before_it_has_its_operands() {
        for entry in [AMBIENT_PROGRAM, START_PROGRAM, STEP_PROGRAM, END_PROGRAM] {
            let (mut now, mut ready, mut marked, mut divided) = (LATENCY, [LATENCY; 64], 0, 0);
            for (place, instruction) in PROGRAM.iter().enumerate().skip(entry as usize) {
                let Instruction { op, to, a, b, c, mark, wait, .. } = *instruction;
                let latency = match op {
                    Op::Reciprocal => 26,
                    Op::Root => 34,
                    _ => LATENCY,
                };
                let early = match op {
                    Op::End => ready.iter().max().is_some_and(|&last| now < last),
                    Op::Exponent | Op::Cut => now < marked,
                    _ => {
                        let operands =
                            ready[if a < 32 { a } else { 62 } as usize].max(ready[b as usize]);
                        now < operands
                            .max(divided)
                            .max(ready[if c < 32 { c } else { 62 } as usize] + LATE - LATENCY)
                    }
                };
                assert!(!early, "{place}");
                if op == Op::End {
                    break;
                }
                if !matches!(op, Op::Exponent | Op::Cut) {
                    assert!(wait >= MULTIPLIED, "{place}");
                    // Places of outputs are those of operands from other blocks.
                    ready[if to < 32 { to } else { 63 } as usize] = now + latency;
                }
                if mark == Mark::Magnitude {
                    marked = now + MARKED;
                }
                if latency > LATENCY {
                    divided = now + latency;
                }
                now += u64::from(wait);
            }
        }
    }
}
