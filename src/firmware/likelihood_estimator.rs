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

use crate::kernel::U;
use crate::{connect, signals, states};

mod duration;
pub mod params;
pub mod pipeline;
pub mod pulse;
mod sequence;
mod slotted;
pub mod tables;
pub mod words;

use super::forward2::Depth;
use super::histogram_builder::Count;
use super::likelihood_memory::{self, LikelihoodMemory, Place};
use super::likelihood_scan::{self, LikelihoodScan};
use super::likelihood_solver::{self, LikelihoodSolver};
use super::likelihood_sums::{self, LikelihoodSums};
use super::likelihood_terms::{self, LikelihoodTerms};

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

impl LikelihoodEstimator {
    /// Returns the state.
    pub fn state(&self) -> State {
        self.registers.state
    }
}

#[cfg(test)]
mod tests;
