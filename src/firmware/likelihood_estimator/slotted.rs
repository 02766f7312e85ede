//! The estimator in the slot of the top: its clock edge, its outputs, and when it rests.

use crate::firmware::histogram_builder;
use crate::firmware::tof_top::slot::{
    Assumptions, EstimateWords, SecondWords, SlotEstimator, SlotOut,
};
use crate::kernel::Clocked;

use super::params::Params;
use super::{In, LikelihoodEstimator, Registers, State, Wires};

impl SlotEstimator for LikelihoodEstimator {
    type In = In;
    type Params = Params;
    const STATES_SIGMA: bool = true;
    const ASSUMES: Assumptions = Assumptions::Model;

    fn params_for(histogram: &histogram_builder::Params) -> Params {
        Params::stand_in(*histogram)
    }

    fn rise(&mut self, i: &In, p: &Params) {
        let (memory, terms) = (Wires::likelihood_memory(self, i), Wires::likelihood_terms(self, i));
        let (sums, scan) = (Wires::likelihood_sums(self, i), Wires::likelihood_scan(self, i));
        let solver = Wires::likelihood_solver(self, i);
        let glass = (p.glass.bins() > 0).then(|| Wires::likelihood_glass(self, i));
        let pair = p.has_second().then(|| Wires::likelihood_pair(self, i));
        let registers = if i.rst { Registers::default() } else { self.next(i, p) };

        self.likelihood_memory.rise(&memory, p);
        self.likelihood_terms.tick(&terms, p);
        self.likelihood_sums.tick(&sums, p);
        if let Some(glass) = glass {
            self.likelihood_glass.tick(&glass, p);
        }
        if let Some(pair) = pair {
            self.likelihood_pair.tick(&pair, p);
        }
        self.likelihood_scan.rise(&scan, p);
        self.likelihood_solver.rise(&solver, p);
        self.registers = registers;
    }

    #[inline(always)]
    fn outputs(&self) -> SlotOut {
        let memory = &self.likelihood_memory.registers;
        let (read_en, read_addr) = (memory.read_en, memory.read_addr);
        let Registers { depth, sigma, status, valid, code, algo_done, .. } = self.registers;
        let Registers { second_depth, second_sigma, second_strength, .. } = self.registers;
        let Registers { second_status, second_valid, .. } = self.registers;
        let second = SecondWords {
            second_depth,
            second_sigma,
            second_strength,
            second_status,
            second_valid,
        };
        let words = EstimateWords { depth, sigma, status, valid, code, second };
        SlotOut { read_en, read_addr, words, algo_done }
    }

    fn cycles(p: &Params) -> u64 {
        p.done()
    }

    fn phase(&self, _: &Params) -> Option<u64> {
        let working = self.registers.state != State::Idle || self.registers.algo_done;
        working.then_some(if self.registers.load { 0 } else { 1 })
    }

    fn rests(&self, i: &In, p: &Params) -> bool {
        self.registers.state == State::Idle
            && self.next(i, p) == self.registers
            && self.likelihood_solver.rests(&Wires::likelihood_solver(self, i), p)
            && self.likelihood_memory.rests(&Wires::likelihood_memory(self, i), p)
            && self.likelihood_scan.rests(&Wires::likelihood_scan(self, i), p)
            && self.likelihood_terms.next(&Wires::likelihood_terms(self, i), p)
                == self.likelihood_terms
            && self.likelihood_sums.next(&Wires::likelihood_sums(self, i), p)
                == self.likelihood_sums
            && (p.glass.bins() == 0
                || self.likelihood_glass.next(&Wires::likelihood_glass(self, i), p)
                    == self.likelihood_glass)
            && (!p.has_second()
                || self.likelihood_pair.next(&Wires::likelihood_pair(self, i), p)
                    == self.likelihood_pair)
    }
}
