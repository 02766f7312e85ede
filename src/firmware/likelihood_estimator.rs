//! Maximum likelihood in integers: a depth at the Cramér-Rao bound, its deviation, and whether to believe it.
//!
//! Of the R shots that still wait when a bin begins, n end in it, and n is binomial with the chance
//! 1 - exp(-lambda): lambda = b W + S G(mu), for a bin of width W into which the part G of a pulse around mu
//! falls. Bin 0 holds all of the pulse that came before its end: the SPAD is armed at the laser edge. The
//! residual and its variance need no logarithm and no division in a bin, as
//! k(lambda) = lambda / (1 - exp(-lambda)) comes from one table:
//!
//! - v = n k - R lambda, zero in the mean,
//! - w = R lambda (k - lambda), its variance and Fisher's information of log lambda.
//!
//! A scan with a box finds the start, and six steps of Fisher scoring in (mu, log S, log b) go on from there.
//! One echo is fitted. What a second one adds outside of the fit's bins counts as ambient light, and a second scan
//! looks for it; one that is nearer than 4 sigma is mixed up with the first, at times without a status
//! (`docs/accuracy.md`).
//! The unit of time is a 64th of a bin; words are as `docs/model.md` has them.

use crate::kernel::{Clocked, U};
use crate::{connect, signals, states};

pub mod params;
pub mod pipeline;
pub mod pulse;
pub mod tables;
pub mod words;

use super::forward2::Depth;
use super::histogram_builder::Count;
use super::likelihood_memory::{self, LikelihoodMemory, Place};
use super::likelihood_scan::{self, LikelihoodScan};
use super::likelihood_solver::program::{
    AMBIENT_PROGRAM, END_PROGRAM, START_PROGRAM, STEP_PROGRAM, program_cycles,
};
use super::likelihood_solver::{self, LikelihoodSolver};
use super::likelihood_sums::{self, LikelihoodSums};
use super::likelihood_terms::{self, LikelihoodTerms};
use super::tof_top::slot::{EstimateWords, SlotEstimator, SlotIn, SlotOut};
use super::tof_top::status::{Status, StatusSet};

use params::Params;
use words::{ANOTHER_SCORE, LEAST_SCORE, LEAST_WAITING, STEPS, SURE_SCORE};

states! {
    /// States of the estimator.
    pub enum State: 4 {
        /// Nothing.
        Idle,
        /// Reads the histogram.
        Load,
        /// Works out the ambient light.
        Ambient,
        /// Slides the box.
        Scan,
        /// Works out where the fit begins.
        Start,
        /// Goes through the bins of the fit.
        Fit,
        /// Takes a step.
        Step,
        /// Goes through them to see how well they fit.
        Check,
        /// Slides the box over all others.
        Rescan,
        /// Works out what comes out.
        End,
    }
}

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// Starts an estimation.
        pub algo_start: bool,
        /// SPADs come back by themselves (MODE 1).
        pub mode: bool,
        /// Word of the histogram at `read_addr` [hits].
        #[size(CountBits)]
        pub count: Count,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Registers {
        /// The depth, when `algo_done` is high, and until the next one.
        pub depth: Depth,
        /// Its standard deviation, with as many fraction bits.
        #[view(heading = "Estimator", probe = true)]
        pub sigma: U<36>,
        /// Why not to believe it; see [`Status`].
        #[view(heading = "Estimator", probe = true)]
        pub status: U<7>,
        /// Chi-square of the fit, 8 fraction bits.
        #[size(ChiBits)]
        #[view(heading = "Estimator", probe = true)]
        pub chi_square: U<35>,
        /// The status says nothing against the depth.
        pub valid: bool,
        /// The depth is ready; one cycle.
        pub algo_done: bool,
        /// State of the computation.
        #[view(heading = "Likelihood", probe = true)]
        pub(crate) state: State,
        /// Cycles in this state.
        #[size(WaitBits)]
        pub(crate) waited: U<13>,
        /// Steps taken.
        #[view(heading = "Likelihood", probe = true)]
        pub(crate) steps: U<3>,
        /// Begins a load.
        pub(crate) load: bool,
        /// Begins a pass.
        pub(crate) pass: bool,
        /// Begins the sums of a pass.
        pub(crate) sums: bool,
        /// A scan is on the way.
        pub(crate) scan: bool,
        /// A check is on the way.
        pub(crate) check: bool,
        /// Second cycle of a beat; there are none but in a pass.
        pub(crate) phase: bool,
        /// Begins a program.
        pub(crate) run: bool,
        /// First instruction of the program.
        pub(crate) entry: U<7>,
        /// Begin of the fit, and of what a scan blanks [bins].
        #[size(PlaceBits)]
        pub(crate) fit_begin: Place,
        /// Its end.
        #[size(PlaceBits)]
        pub(crate) fit_end: Place,
        /// Score of the first scan.
        pub(crate) start_score: likelihood_scan::Log,
        /// A bin of the check has come.
        pub(crate) seen: bool,
        /// Few shots waited at the first.
        pub(crate) used_up: bool,
        /// `mode` was high since the last estimation began.
        pub(crate) free: bool,
        /// The same of the shots of this estimation.
        pub(crate) unarmed: bool,
    }
}

/// The blocks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LikelihoodEstimator {
    /// Sequence and results.
    pub registers: Registers,
    /// Counts.
    pub likelihood_memory: LikelihoodMemory,
    /// Terms of a bin.
    pub likelihood_terms: LikelihoodTerms,
    /// Their sums.
    pub likelihood_sums: LikelihoodSums,
    /// The box.
    pub likelihood_scan: LikelihoodScan,
    /// Arithmetic.
    pub likelihood_solver: LikelihoodSolver,
}

connect! {
    /// Port connections.
    pub struct Wires(this: &LikelihoodEstimator, i: &In) {
        signals registers;
        output read_en <- this.likelihood_memory.registers.read_en;
        output read_addr <- this.likelihood_memory.registers.read_addr;
    }
    likelihood_memory(clk_sys): likelihood_memory::In {
        rst <- i.rst;
        load <- this.registers.load;
        count <- i.count;
        pass <- this.registers.pass;
        scan <- this.registers.scan;
        fit_begin <- this.registers.fit_begin;
        fit_end <- this.registers.fit_end;
        phase <- this.registers.phase;
    }
    likelihood_terms(clk_sys): likelihood_terms::In {
        phase <- this.registers.phase;
        scan <- this.registers.scan;
        arrival <- this.likelihood_solver.registers.arrival;
        strength <- this.likelihood_solver.registers.strength;
        ambient <- this.likelihood_solver.registers.ambient;
        word_bin <- this.likelihood_memory.registers.word_bin;
        word_rest <- this.likelihood_memory.registers.word_rest;
        word_edge <- this.likelihood_memory.registers.word_edge;
        word_slide <- this.likelihood_memory.registers.word_slide;
        word_first <- this.likelihood_memory.registers.word_first;
        word_ended <- this.likelihood_memory.registers.word_ended;
        word_waiting <- this.likelihood_memory.registers.word_waiting;
        word_width <- this.likelihood_memory.registers.word_width;
        word_end <- this.likelihood_memory.registers.word_end;
    }
    likelihood_sums(clk_sys): likelihood_sums::In {
        pass <- this.registers.sums;
        check <- this.registers.check;
        phase <- this.registers.phase;
        residual <- this.likelihood_terms.residual;
        predicted <- this.likelihood_terms.predicted;
        gain <- this.likelihood_terms.gain;
        share <- this.likelihood_terms.share;
        slope <- this.likelihood_terms.slope;
        single <- this.likelihood_terms.single;
    }
    likelihood_scan(clk_sys): likelihood_scan::In {
        load <- this.registers.load;
        block_done <- this.likelihood_memory.registers.block_done;
        block_ended <- this.likelihood_memory.registers.block_ended;
        block_exposure <- this.likelihood_memory.registers.block_exposure;
        pass <- this.registers.pass;
        scan <- this.registers.scan;
        phase <- this.registers.phase;
        slide <- this.likelihood_terms.slide;
        residual <- this.likelihood_terms.residual;
        predicted <- this.likelihood_terms.predicted;
        middle <- this.likelihood_terms.middle;
        waits <- this.likelihood_terms.waits;
    }
    likelihood_solver(clk_sys): likelihood_solver::In {
        rst <- i.rst;
        run <- this.registers.run;
        entry <- this.registers.entry;
        ambient_ended <- this.likelihood_scan.registers.ambient_ended;
        ambient_exposure <- this.likelihood_scan.registers.ambient_exposure;
        lone <- this.likelihood_scan.registers.lone;
        best_excess <- this.likelihood_scan.registers.best_excess;
        best_middle <- this.likelihood_scan.registers.best_middle;
        box_length <- this.likelihood_scan.registers.box_length;
        box_sum <- this.likelihood_scan.registers.box_sum;
        sum_11 <- this.likelihood_sums.sum_11;
        sum_12 <- this.likelihood_sums.sum_12;
        sum_13 <- this.likelihood_sums.sum_13;
        sum_22 <- this.likelihood_sums.sum_22;
        sum_23 <- this.likelihood_sums.sum_23;
        sum_33 <- this.likelihood_sums.sum_33;
        score_1 <- this.likelihood_sums.score_1;
        score_2 <- this.likelihood_sums.score_2;
        score_3 <- this.likelihood_sums.score_3;
    }
}

/// Beats from a bin in the memory to the sums, or to the highest box, with one for the edge.
const BEATS: u64 = 29;
/// Cycles from the last word of a load to the block that it completes.
const LOADED: u64 = 12;
impl Params {
    /// Cycles of a load.
    pub fn load_cycles(&self) -> u64 {
        self.histogram.bins as u64 + LOADED
    }

    /// From the edge that takes `algo_start` to the one that raises `algo_done`: a load, two scans, a pass for
    /// each step and one to check, each of bins, and the programs between them, which are as long whatever is in
    /// the histogram [cycles of clk_sys].
    pub fn done(&self) -> u64 {
        let passes = STEPS as u64 + 1;
        let programs = program_cycles(AMBIENT_PROGRAM)
            + program_cycles(START_PROGRAM)
            + STEPS as u64 * program_cycles(STEP_PROGRAM)
            + program_cycles(END_PROGRAM);
        let states = 1 + 2 + passes;
        self.load_cycles() + 2 * self.scan_cycles() + passes * self.fit_cycles() + programs + states
    }

    /// Cycles of a scan.
    pub fn scan_cycles(&self) -> u64 {
        2 * (self.histogram.bins as u64 + self.scan_tail() + BEATS)
    }

    /// Cycles of a pass over the bins of a fit.
    pub fn fit_cycles(&self) -> u64 {
        2 * (self.fitted() as u64 + BEATS)
    }
}

impl From<SlotIn> for In {
    fn from(SlotIn { rst, algo_start, mode, count }: SlotIn) -> Self {
        In { rst, algo_start, mode, count }
    }
}

impl SlotEstimator for LikelihoodEstimator {
    type In = In;
    type Params = Params;
    const STATES_SIGMA: bool = true;

    fn rise(&mut self, i: &In, p: &Params) {
        let (memory, terms) = (Wires::likelihood_memory(self, i), Wires::likelihood_terms(self, i));
        let (sums, scan) = (Wires::likelihood_sums(self, i), Wires::likelihood_scan(self, i));
        let solver = Wires::likelihood_solver(self, i);
        let registers = if i.rst { Registers::default() } else { self.next(i, p) };

        self.likelihood_memory.rise(&memory, p);
        self.likelihood_terms.tick(&terms, p);
        self.likelihood_sums.tick(&sums, p);
        self.likelihood_scan.rise(&scan, p);
        self.likelihood_solver.rise(&solver, p);
        self.registers = registers;
    }

    #[inline(always)]
    fn outputs(&self) -> SlotOut {
        let memory = &self.likelihood_memory.registers;
        let (read_en, read_addr) = (memory.read_en, memory.read_addr);
        let Registers { depth, sigma, status, valid, algo_done, .. } = self.registers;
        let words = EstimateWords { depth, sigma, status, valid };
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
    }
}

impl LikelihoodEstimator {
    /// Returns the state.
    pub fn state(&self) -> State {
        self.registers.state
    }

    fn next(&self, i: &In, p: &Params) -> Registers {
        let q = &self.registers;
        let mut d = *q;
        (d.load, d.pass, d.sums, d.run, d.algo_done) = Default::default();
        d.free |= i.mode;
        let passes = [State::Scan, State::Fit, State::Check, State::Rescan].contains(&q.state);
        d.phase = passes && !q.pass && !q.phase;
        d.waited = q.waited + 1;
        let after = |cycles: u64| q.waited == cycles;
        let ran = self.likelihood_solver.registers.ran;
        match q.state {
            State::Idle if i.algo_start => {
                (d.state, d.load) = (State::Load, true);
                (d.fit_begin, d.fit_end, d.steps) = Default::default();
                (d.unarmed, d.free) = (d.free, i.mode);
            }
            State::Load if after(p.load_cycles()) => d.solve(State::Ambient, AMBIENT_PROGRAM),
            State::Ambient if ran => d.slide(State::Scan),
            State::Scan if after(p.scan_cycles()) => {
                d.start_score = self.likelihood_scan.registers.best_score;
                d.solve(State::Start, START_PROGRAM);
            }
            State::Start if ran => self.fit(State::Fit, p, &mut d),
            State::Fit if after(p.fit_cycles()) => d.solve(State::Step, STEP_PROGRAM),
            State::Step if ran => {
                let last = q.steps == STEPS as u64 - 1;
                d.steps = q.steps + 1;
                self.fit(if last { State::Check } else { State::Fit }, p, &mut d);
            }
            State::Check if after(p.fit_cycles()) => d.slide(State::Rescan),
            State::Check => self.look(&mut d),
            State::Rescan if after(p.scan_cycles()) => d.solve(State::End, END_PROGRAM),
            State::End if ran => self.give(p, &mut d),
            _ => {}
        }
        if d.state == State::Idle || d.state != q.state || d.pass {
            d.waited = U::new(0);
        }
        d
    }

    /// Begins a pass over the bins around the arrival.
    fn fit(&self, state: State, p: &Params, d: &mut Registers) {
        let bins = p.histogram.bins as u64;
        let centre = (self.likelihood_solver.registers.arrival.get() >> 10).min(bins - 1);
        d.fit_begin = U::new(centre.saturating_sub(p.before as u64));
        d.fit_end = U::new((centre + p.after as u64 + 1).min(bins));
        (d.pass, d.sums, d.state) = (true, true, state);
        d.check = state == State::Check;
        d.seen = false;
    }

    /// Looks at the first bin of the check.
    fn look(&self, d: &mut Registers) {
        let memory = &self.likelihood_memory.registers;
        if memory.word_bin && !self.registers.seen {
            d.seen = true;
            d.used_up = memory.word_waiting.get() < LEAST_WAITING;
        }
    }

    /// Gives what has come out.
    fn give(&self, p: &Params, d: &mut Registers) {
        let solver = &self.likelihood_solver.registers;
        let flag = |flag: u64| solver.flags.get() >> flag & 1 != 0;
        let unsure = flag(1) && d.start_score.get() < SURE_SCORE;
        let no_echo = unsure || flag(0) || flag(2) || d.start_score.get() < LEAST_SCORE;
        let reasons = [
            (no_echo, Status::NoEcho),
            (flag(3) || flag(4), Status::CutOff),
            (d.used_up, Status::UsedUp),
            (self.likelihood_scan.registers.best_score.get() > ANOTHER_SCORE, Status::Another),
            (solver.cut != 0 || flag(5) || flag(6), Status::NotSettled),
            (self.likelihood_sums.far, Status::NoFit),
            (d.unarmed, Status::Unarmed),
        ];
        d.status = U::new(StatusSet::of(&reasons).bits().into());
        d.valid = d.status == 0;
        // An arrival counts from the laser edge, a depth from where the light leaves.
        (d.depth, d.sigma) = (Depth::new(solver.depth.get() - p.delay), solver.sigma);
        d.chi_square = self.likelihood_sums.chi_square;
        (d.algo_done, d.scan, d.state) = (true, false, State::Idle);
    }
}

impl Registers {
    /// Begins a program.
    fn solve(&mut self, state: State, program: u64) {
        (self.state, self.run, self.entry) = (state, true, U::new(program));
        self.scan = false;
    }

    /// Begins a scan.
    fn slide(&mut self, state: State) {
        (self.state, self.pass, self.scan, self.check) = (state, true, true, false);
    }
}

#[cfg(test)]
mod tests;
