//! The order of loads, scans, passes and programs, and the result.

use crate::firmware::forward2::Depth;
use crate::firmware::tof_top::status::{Status, StatusSet};
use crate::firmware::tof_top::status_code::{CodeConditions, StatusCode};
use crate::kernel::U;

use super::params::Params;
use super::words::{
    ANOTHER_SCORE, CERTAIN_SCORE, GLASS_STEPS, LEAST_SCORE, LEAST_WAITING, STEPS, SURE_SCORE,
};
use super::{In, LikelihoodEstimator, Registers, State};

impl LikelihoodEstimator {
    pub(super) fn next(&self, i: &In, p: &Params) -> Registers {
        let q = &self.registers;
        let mut d = *q;
        (d.load, d.pass, d.sums, d.run, d.algo_done) = Default::default();
        d.free |= i.mode;
        let passes = [State::Scan, State::Fit, State::Check, State::Rescan].contains(&q.state);
        d.phase = passes && !q.pass && !q.phase;
        d.waited = q.waited + 1;
        let after = |cycles: u64| q.waited == cycles;
        let ran = self.likelihood_solver.registers.ran;
        let (program, has_glass) = (p.program(), p.glass.bins() > 0);
        let fit_cycles = if q.wide { p.pair_cycles() } else { p.fit_cycles() };
        match q.state {
            State::Idle if i.algo_start => {
                (d.state, d.load) = (State::Load, true);
                (d.fit_begin, d.fit_end, d.steps) = Default::default();
                (d.wide, d.paired, d.turns) = Default::default();
                (d.unarmed, d.free) = (d.free, i.mode);
            }
            State::Load if after(p.load_cycles()) => d.solve(State::Ambient, program.ambient),
            State::Ambient if ran && has_glass => {
                d.dark = true;
                self.fit(State::Fit, p, &mut d);
            }
            State::Ambient if ran => {
                d.dark = p.has_second();
                d.slide(State::Scan);
            }
            State::Scan if after(p.scan_cycles()) => {
                d.start_score = self.likelihood_scan.registers.best_score;
                d.solve(State::Start, program.start);
            }
            State::Start if ran => {
                d.dark = false;
                self.fit(State::Fit, p, &mut d);
            }
            State::Fit if after(fit_cycles) => d.solve(State::Step, program.step),
            State::Step if ran && q.paired => self.turn(p, &mut d),
            State::Step if ran && q.dark && q.steps == GLASS_STEPS as u64 - 1 => {
                d.steps = U::new(0);
                d.slide(State::Scan);
            }
            State::Step if ran => {
                let last = q.steps == STEPS as u64 - 1;
                d.steps = q.steps + 1;
                match (last, p.has_second()) {
                    (true, true) => d.solve(State::End, program.end),
                    (true, false) => self.fit(State::Check, p, &mut d),
                    _ => self.fit(State::Fit, p, &mut d),
                }
            }
            State::Check if after(fit_cycles) && p.has_second() && !q.paired => {
                self.keep_alone(&mut d);
                d.solve(State::Swap, program.swap);
            }
            State::Check if after(fit_cycles) => d.slide(State::Rescan),
            State::Check => self.look(has_glass, &mut d),
            State::Rescan if after(p.scan_cycles()) && p.has_second() && !q.paired => {
                d.alone_score = self.likelihood_scan.registers.best_score;
                d.solve(State::Second, program.second);
            }
            State::Rescan if after(p.scan_cycles()) => d.solve(State::End, program.end),
            State::Second if ran => {
                d.wide = true;
                self.fit(State::Check, p, &mut d);
            }
            State::Swap if ran => self.fit(State::Fit, p, &mut d),
            State::End if ran && p.has_second() => self.end(p, &mut d),
            State::End if ran => self.give(p, &mut d),
            _ => {}
        }
        if d.state == State::Idle || d.state != q.state || d.pass {
            d.waited = U::new(0);
        }
        d
    }

    /// Begins a pass over the bins around the arrival.
    pub(super) fn fit(&self, state: State, p: &Params, d: &mut Registers) {
        let around = |arrival: u64| {
            let bins = p.histogram.bins as u64;
            let centre = (arrival >> 10).min(bins - 1);
            let begin = centre.saturating_sub(p.before as u64);
            (U::new(begin), U::new((centre + p.after as u64 + 1).min(bins)))
        };
        let solver = &self.likelihood_solver.registers;
        let own = around(solver.arrival.get());
        (d.fit_begin, d.fit_end) = if d.dark { Default::default() } else { own };
        if p.has_second() {
            let other = around(solver.other_arrival.get());
            d.behind = d.wide && other.0 < own.0;
            (d.later_begin, d.later_end) = if d.behind { own } else { other };
            if d.behind {
                (d.fit_begin, d.fit_end) = other;
            }
        }
        (d.pass, d.sums, d.state) = (true, true, state);
        d.check = state == State::Check;
        (d.seen, d.reached) = (false, false);
        (d.later_seen, d.later_reached) = (false, false);
    }

    /// Looks at the first bin of the check, with a cover glass at the first one of the window around the echo.
    fn look(&self, has_glass: bool, d: &mut Registers) {
        let memory = &self.likelihood_memory.registers;
        d.reached |= has_glass && memory.word_window;
        if memory.word_bin && !self.registers.seen && (d.reached || !has_glass) {
            d.seen = true;
            d.used_up = memory.word_waiting.get() < LEAST_WAITING;
        }
        d.later_reached |= memory.word_later;
        if memory.word_bin && !self.registers.later_seen && d.later_reached {
            d.later_seen = true;
            d.later_used_up = memory.word_waiting.get() < LEAST_WAITING;
        }
    }

    /// Gives what has come out.
    pub(super) fn give(&self, p: &Params, d: &mut Registers) {
        let solver = &self.likelihood_solver.registers;
        let flag = |flag: u64| solver.flags.get() >> flag & 1 != 0;
        let unsure = flag(1) && d.start_score.get() < SURE_SCORE;
        let faint = flag(0) && d.start_score.get() < CERTAIN_SCORE;
        let no_echo = unsure || faint || flag(2) || d.start_score.get() < LEAST_SCORE;
        let has_changed = self.has_changed(p);
        let reasons = [
            (no_echo, Status::NoEcho),
            (flag(3) || flag(4), Status::CutOff),
            (d.used_up, Status::UsedUp),
            (self.likelihood_scan.registers.best_score.get() > ANOTHER_SCORE, Status::Another),
            (solver.cut != 0 || flag(5) || flag(6), Status::NotSettled),
            (self.likelihood_sums.far || has_changed, Status::NoFit),
            (d.unarmed, Status::Unarmed),
        ];
        let status = StatusSet::of(&reasons);
        d.status = U::new(status.bits().into());
        d.valid = d.status == 0;
        d.code = StatusCode::of(status, self.conditions(p, has_changed));
        // An arrival counts from the laser edge, a depth from where the light leaves.
        (d.depth, d.sigma) = (Depth::new(solver.depth.get() - p.delay), solver.sigma);
        d.chi_square = self.likelihood_sums.chi_square;
        (d.algo_done, d.scan, d.state) = (true, false, State::Idle);
    }

    /// Returns the conditions of a code with one target.
    pub(super) fn conditions(&self, p: &Params, has_changed: bool) -> CodeConditions {
        let left = self.likelihood_memory.registers.left.get();
        CodeConditions { is_blind: left < p.least_left(), has_changed, has_second: false }
    }

    /// Returns whether the cover glass's light is beyond what the calibration holds for.
    pub(super) fn has_changed(&self, p: &Params) -> bool {
        let glass = self.likelihood_solver.registers.glass.get() as i64;
        let [least, most] = p.glass.limits();
        p.glass.bins() > 0 && (glass < least || glass > most)
    }
}

impl Registers {
    /// Begins a program.
    pub(super) fn solve(&mut self, state: State, program: u64) {
        (self.state, self.run, self.entry) = (state, true, U::new(program));
        self.scan = false;
    }

    /// Begins a scan.
    pub(super) fn slide(&mut self, state: State) {
        (self.state, self.pass, self.scan, self.check) = (state, true, true, false);
    }
}
