//! Where operands come from and where results go: the memory, other blocks, the output ports.

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::words::SCARCE;
use crate::kernel::{S, U, wrapped};

use super::instruction::{FLAGS, MAGNITUDE, Op};
use super::places::{self, ONE, is_own};
use super::{In, LEAST_MAGNITUDE, LOW_BITS, LikelihoodSolver, Registers};

impl LikelihoodSolver {
    /// Reads the operands; c comes late.
    pub(super) fn fetch(&self, i: &In, p: &Params, d: &mut Registers) {
        let q = &self.registers;
        let word = |place: u8| match place {
            ONE..32 => p.constants()[(place - ONE) as usize],
            places::CALIBRATED => p.glass.light,
            _ => self.words[place as usize].get(),
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
            let now = q.instruction(p, 5);
            (d.minus, d.divides, d.roots) = (now.minus, !q.alu, now.op == Op::Root);
        }
    }

    /// Writes a result.
    pub(super) fn keep(&mut self, i: &In, p: &Params, d: &mut Registers) {
        let q = self.registers;
        if !q.at[8] {
            return;
        }
        let (to, result) = (q.to.get() as u8, q.result.get());
        match to {
            places::DEPTH => d.depth = S::new(result),
            places::SIGMA => d.sigma = U::new(result as u64),
            to => self.words[to as usize] = S::new(result),
        }
        match to {
            places::ARRIVAL => d.arrival = U::new(result as u64),
            places::SIGNAL => d.strength = U::new(result as u64),
            places::AMBIENT => d.ambient = U::new(result as u64),
            places::GLASS => d.glass = U::new(result as u64),
            places::OTHER_ARRIVAL => d.other_arrival = U::new(result as u64),
            places::OTHER_SIGNAL => d.other_strength = U::new(result as u64),
            places::A33 => d.scarce = result < SCARCE,
            _ => {}
        }
        if q.mark == MAGNITUDE && !i.run && !q.measures(p) {
            let high = result.unsigned_abs() >> LEAST_MAGNITUDE;
            d.magnitude = U::new(q.magnitude.get() | high);
        }
        if let Some(flag) = q.mark.get().checked_sub(FLAGS) {
            let others = q.flags.get() & !(1 << flag);
            d.flags = U::new(others | u64::from(result < 0) << flag);
        }
    }
}

impl Params {
    /// The constants of the solver's memory, from [`ONE`] on.
    pub fn constants(&self) -> [i64; 32 - ONE as usize] {
        let (kappa, stride, end) = (self.kappa, self.stride(), self.end());
        let (wide, margin) = (self.sigma << 4, self.sigma << 3);
        [1, kappa, stride, self.metres, 341, 19, 1 << LOW_BITS, 0, wide, margin, end, 64, 40, 2]
    }
}

impl In {
    /// Returns the operand `a` if it comes from another block.
    fn first_operand(&self, place: u8) -> Option<i64> {
        Some(match other(place)? {
            0 => self.on_ambient().0 >> 5,
            1 => self.on_ambient().1,
            2 => self.on_ambient().2,
            3 => self.on_ambient().3 << 2,
            4 if self.lone => (self.ambient_ended.get() << 12) as i64,
            4 => (self.ambient_ended.get() << 16) as i64,
            5 => self.ambient_exposure.get() as i64,
            6 => self.best_excess.get() << 4,
            7 => self.best_middle.get() as i64,
            8 => self.box_length.get() as i64,
            9 => (self.box_sum.get() << 9) as i64,
            11 => self.score_4.get() << 2,
            12 => self.sum_14.get() >> 5,
            13 => self.sum_24.get(),
            14 => self.sum_34.get(),
            _ => self.sum_44.get(),
        })
    }

    /// Returns the operand `c` if it comes from another block.
    fn third_operand(&self, place: u8) -> Option<i64> {
        Some(match other(place)? {
            0 => self.sum_11.get() >> 1,
            1 => self.sum_12.get() >> 5,
            2 => self.sum_22.get(),
            3 => self.score_1.get() >> 3,
            4..8 => self.score_2.get() << 2,
            8 => self.on_ambient().0 >> 5,
            9 => self.on_ambient().1,
            10 => self.on_ambient().2,
            _ => self.on_ambient().3 << 2,
        })
    }

    /// Returns the information on log b with mu, log S and alone, and its score: of all light but the signal, or with
    /// another echo of all but both.
    pub(super) fn on_ambient(&self) -> (i64, i64, i64, i64) {
        if self.paired {
            let In { still_13, still_23, still_33, still_score, .. } = self;
            (still_13.get(), still_23.get(), still_33.get(), still_score.get())
        } else {
            let In { sum_13, sum_23, sum_33, score_3, .. } = self;
            (sum_13.get(), sum_23.get(), sum_33.get(), score_3.get())
        }
    }
}

/// Returns the number of an operand from another block.
fn other(place: u8) -> Option<u8> {
    (!is_own(place)).then(|| place - 32)
}
