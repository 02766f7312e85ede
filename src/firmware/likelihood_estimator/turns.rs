//! Two echoes in turn, and whether there are two.

use crate::firmware::forward2::Depth;
use crate::firmware::tof_top::status::{Status, StatusSet};
use crate::firmware::tof_top::status_code::StatusCode;
use crate::kernel::{S, U};

use super::params::Params;
use super::targets::{HINT, LEAST_APART, LEAST_DROP, NEAR, TURNS, Targets};
use super::words::{ANOTHER_SCORE, CERTAIN_SCORE, LEAST_SCORE, SURE_SCORE};
use super::{LikelihoodEstimator, Registers, State};

/// Results of an echo, of which the solver's flags say what is against it.
struct Echo {
    depth: S<36, 29>,
    sigma: U<36>,
    strength: U<24>,
    flags: u64,
    was_cut: bool,
    used_up: bool,
}

impl Echo {
    fn flag(&self, flag: u64) -> bool {
        self.flags >> flag & 1 != 0
    }

    /// Returns what is against it, whatever else there is.
    fn reasons(&self) -> [(bool, Status); 3] {
        [
            (self.flag(3) || self.flag(4), Status::CutOff),
            (self.used_up, Status::UsedUp),
            (self.was_cut || self.flag(5) || self.flag(6), Status::NotSettled),
        ]
    }

    /// Returns whether its signal is known to a fifth, and its place.
    fn is_certain(&self) -> bool {
        !self.flag(1) && !self.flag(2)
    }
}

impl LikelihoodEstimator {
    /// After a step of one of two echoes, turns to the other; the results of each are computed after its last step.
    pub(super) fn turn(&self, p: &Params, d: &mut Registers) {
        let (turns, program) = (self.registers.turns.get(), p.program());
        d.turns = self.registers.turns + 1;
        if turns == TURNS as u64 - 2 {
            d.solve(State::End, program.end);
        } else if turns == TURNS as u64 - 1 {
            self.fit(State::Check, p, d);
        } else {
            d.solve(State::Swap, program.swap);
        }
    }

    /// Keeps what the check of one echo has found.
    pub(super) fn keep_alone(&self, d: &mut Registers) {
        let q = &self.registers;
        d.alone_chi = self.likelihood_sums.chi_square;
        d.alone_far = self.likelihood_sums.far;
        d.alone_used_up = if q.behind { q.later_used_up } else { q.used_up };
        d.paired = true;
    }

    /// Keeps the results of one echo, or of the other of two, or gives all.
    pub(super) fn end(&self, p: &Params, d: &mut Registers) {
        let (q, solver) = (&self.registers, &self.likelihood_solver.registers);
        if !q.paired {
            (d.alone_depth, d.alone_sigma) = (solver.depth, solver.sigma);
            (d.alone_flags, d.alone_cut) = (solver.flags, solver.cut != 0);
            d.alone_changed = self.has_changed(p);
            d.slide(State::Rescan);
        } else if q.turns != TURNS as u64 {
            (d.other_depth, d.other_sigma) = (solver.depth, solver.sigma);
            (d.other_flags, d.other_cut) = (solver.flags, solver.cut != 0);
            d.solve(State::Swap, p.program().swap);
        } else {
            self.give_targets(p, d);
        }
    }

    /// Gives one target or two.
    fn give_targets(&self, p: &Params, d: &mut Registers) {
        let (q, solver) = (&self.registers, &self.likelihood_solver.registers);
        let is_another = self.likelihood_scan.registers.best_score.get() > ANOTHER_SCORE;
        let own = Echo {
            depth: solver.depth,
            sigma: solver.sigma,
            strength: solver.strength,
            flags: solver.flags.get(),
            was_cut: solver.cut != 0,
            used_up: if q.behind { q.later_used_up } else { q.used_up },
        };
        let other = Echo {
            depth: q.other_depth,
            sigma: q.other_sigma,
            strength: solver.other_strength,
            flags: q.other_flags.get(),
            was_cut: q.other_cut,
            used_up: if q.behind { q.used_up } else { q.later_used_up },
        };
        let drop = q.alone_chi.get() as i64 - self.likelihood_sums.chi_square.get() as i64;
        let apart = solver.arrival.get().abs_diff(solver.other_arrival.get()) as i64;
        let are_two = drop > LEAST_DROP
            && apart > LEAST_APART * p.sigma
            && own.is_certain()
            && other.is_certain();
        let is_first = match p.targets {
            Targets::StrongestFirst => own.strength.get() >= other.strength.get(),
            _ => own.depth.get() <= other.depth.get(),
        };
        let [first, second] = if is_first { [own, other] } else { [other, own] };
        let has_changed = self.has_changed(p);
        let of_both = [
            (is_another, Status::Another),
            (self.likelihood_sums.far || has_changed, Status::NoFit),
            (d.unarmed, Status::Unarmed),
        ];
        let word = |echo: &Echo| {
            let reasons: Vec<_> = echo.reasons().into_iter().chain(of_both).collect();
            U::new(StatusSet::of(&reasons).bits().into())
        };
        let delayed = |depth: S<36, 29>| Depth::new(depth.get() - p.delay);
        let mut conditions;
        if are_two {
            (d.depth, d.sigma, d.status) = (delayed(first.depth), first.sigma, word(&first));
            (d.second_depth, d.second_sigma) = (delayed(second.depth), second.sigma);
            (d.second_strength, d.second_status) = (second.strength, word(&second));
            d.chi_square = self.likelihood_sums.chi_square;
            conditions = self.conditions(p, has_changed);
            conditions.has_second = true;
        } else {
            let is_split = drop > LEAST_DROP || drop > HINT && apart < NEAR * p.sigma;
            (d.depth, d.sigma) = (delayed(q.alone_depth), q.alone_sigma);
            d.status = self.status_alone(is_split);
            (d.second_depth, d.second_sigma) = Default::default();
            (d.second_strength, d.second_status) = Default::default();
            d.chi_square = q.alone_chi;
            conditions = self.conditions(p, q.alone_changed);
        }
        d.code = StatusCode::of(d.status.into(), conditions);
        (d.valid, d.second_valid) = (d.status == 0, are_two && d.second_status == 0);
        (d.algo_done, d.scan, d.state) = (true, false, State::Idle);
    }

    /// Returns the status of one echo, which may be two near each other.
    fn status_alone(&self, is_split: bool) -> U<7> {
        let q = &self.registers;
        let flag = |flag: u64| q.alone_flags.get() >> flag & 1 != 0;
        let unsure = flag(1) && q.start_score.get() < SURE_SCORE;
        let faint = flag(0) && q.start_score.get() < CERTAIN_SCORE;
        let no_echo = unsure || faint || flag(2) || q.start_score.get() < LEAST_SCORE;
        let reasons = [
            (no_echo, Status::NoEcho),
            (flag(3) || flag(4), Status::CutOff),
            (q.alone_used_up, Status::UsedUp),
            (is_split || q.alone_score.get() > ANOTHER_SCORE, Status::Another),
            (q.alone_cut || flag(5) || flag(6), Status::NotSettled),
            (q.alone_far || q.alone_changed, Status::NoFit),
            (q.unarmed, Status::Unarmed),
        ];
        U::new(StatusSet::of(&reasons).bits().into())
    }
}
