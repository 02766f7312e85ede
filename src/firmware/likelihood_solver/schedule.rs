//! When the instructions of a program begin.

use super::instruction::{Instruction, Mark, Op};
use super::places::is_own;

/// Cycles from an instruction to one that has its result as `a` or `b`, or as `c`.
const LATENCY: u64 = 9;
const LATE: u64 = 4;
/// The same where the result is a reciprocal or a root.
const RECIPROCAL_LATENCY: u64 = 26;
const ROOT_LATENCY: u64 = 34;
/// Cycles from an instruction whose magnitude is marked to its measure.
const MARKED: u64 = 10;

/// Lets each instruction begin as soon as it has its operands.
pub fn schedule(program: &mut [Instruction]) {
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
