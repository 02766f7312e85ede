//! Which instruction begins, and which is in each of the nine cycles.

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::tables::length;
use crate::kernel::U;

use super::instruction::{Instruction, Op};
use super::{In, LEAST_MAGNITUDE, Registers};

impl Registers {
    /// The instruction that is in a cycle.
    pub(super) fn instruction(&self, p: &Params, cycle: usize) -> &'static Instruction {
        let instructions = &p.program().instructions;
        &instructions[self.number[cycle].index() % instructions.len()]
    }

    /// The next one.
    fn next_one(&self, p: &Params) -> &'static Instruction {
        let instructions = &p.program().instructions;
        &instructions[self.counter.index() % instructions.len()]
    }

    /// Returns whether an instruction begins.
    fn begins(&self) -> bool {
        self.running && self.pause == 0
    }

    /// Returns whether the marked values are measured.
    pub(super) fn measures(&self, p: &Params) -> bool {
        self.begins() && matches!(self.next_one(p).op, Op::Exponent | Op::Cut)
    }

    /// Begins an instruction; one that measures is done at once.
    pub(super) fn begin(&self, i: &In, p: &Params, d: &mut Self) {
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
        let now = self.next_one(p);
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
        if self.measures(p) {
            d.magnitude = U::new(0);
        }
        d.at[0] = matches!(now.op, Op::Alu | Op::Reciprocal | Op::Root);
    }

    /// Moves instructions on; a reciprocal or a root waits until it has its bits.
    pub(super) fn go_on(&self, p: &Params, d: &mut Self) {
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
        let now = self.instruction(p, 2);
        (d.base, d.by) = (U::new(now.shift.into()), U::new(now.by as u64));
        let now = self.instruction(p, 4);
        (d.from_c, d.alu) = (U::new(now.c.into()), now.op == Op::Alu);
        let now = self.instruction(p, 7);
        d.to = U::new(now.to.into());
        d.mark = U::new(now.mark.number());
    }
}
