//! Maximum likelihood in integers: a depth at the Cramér-Rao bound, its standard deviation, and its status.
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
pub mod glass;
pub mod params;
pub mod pipeline;
pub mod pulse;
mod sequence;
mod slotted;
pub mod tables;
mod unfit;
pub mod words;

use super::forward2::Depth;
use super::likelihood_glass::{self, LikelihoodGlass};
use super::likelihood_memory::{self, LikelihoodMemory, Place};
use super::likelihood_scan::{self, LikelihoodScan};
use super::likelihood_solver::{self, LikelihoodSolver};
use super::likelihood_sums::{self, LikelihoodSums};
use super::likelihood_terms::{self, LikelihoodTerms};

pub use super::tof_top::slot::SlotIn as In;

states! {
    /// States of the estimator.
    pub enum State: 4 {
        /// Nothing.
        Idle,
        /// Reads the histogram.
        Load,
        /// Computes the ambient light.
        Ambient,
        /// Slides the box.
        Scan,
        /// Computes the begin of the fit.
        Start,
        /// Passes over the bins of the fit.
        Fit,
        /// Takes a step.
        Step,
        /// Passes over them for the chi-square.
        Check,
        /// Slides the box over all others.
        Rescan,
        /// Computes the results.
        End,
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
        /// Reasons to reject the depth; see [`Status`].
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
        /// A fit or a scan is without an echo.
        #[only_if(Glass)]
        pub(crate) dark: bool,
        /// The check has come to the window around the echo.
        #[only_if(Glass)]
        pub(crate) reached: bool,
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
    /// The cover glass.
    pub likelihood_glass: LikelihoodGlass,
    /// The box.
    pub likelihood_scan: LikelihoodScan,
    /// Arithmetic.
    pub likelihood_solver: LikelihoodSolver,
}

connect! {
    /// Port connections.
    pub struct Wires(this: &LikelihoodEstimator, i: &In) {
        signals registers;
        output [read_en, read_addr] <- this.likelihood_memory.registers;
    }
    likelihood_memory(clk_sys): likelihood_memory::In {
        rst <- i.rst;
        load <- this.registers.load;
        [depth_column, count] <- i;
        [pass, scan, fit_begin, fit_end, phase] <- this.registers;
    }
    likelihood_terms(clk_sys): likelihood_terms::In {
        [phase, scan, dark] <- this.registers;
        glass_light <- this.likelihood_glass.glass_light;
        [arrival, strength, ambient] <- this.likelihood_solver.registers;
        [
            word_bin, word_rest, word_edge, word_slide, word_first, word_ended, word_waiting,
            word_width, word_end
        ] <- this.likelihood_memory.registers;
    }
    likelihood_sums(clk_sys): likelihood_sums::In {
        pass <- this.registers.sums;
        [check, phase] <- this.registers;
        [residual, predicted, gain, share, slope, single] <- this.likelihood_terms;
    }
    likelihood_glass(clk_sys): likelihood_glass::In {
        pass <- this.registers.sums;
        phase <- this.registers.phase;
        glass <- this.likelihood_solver.registers.glass;
        word_glass <- this.likelihood_memory.registers.word_glass;
        [hazard_bits, hazard_reciprocal, residual, share, slope] <- this.likelihood_terms;
        weight_first <- this.likelihood_sums.weight_first;
    }
    likelihood_scan(clk_sys): likelihood_scan::In {
        load <- this.registers.load;
        [block_done, block_ended, block_exposure] <- this.likelihood_memory.registers;
        [pass, scan, phase] <- this.registers;
        [slide, residual, predicted, middle, waits] <- this.likelihood_terms;
    }
    likelihood_solver(clk_sys): likelihood_solver::In {
        rst <- i.rst;
        [run, entry] <- this.registers;
        [
            ambient_ended, ambient_exposure, lone, best_excess, best_middle, box_length, box_sum
        ] <- this.likelihood_scan.registers;
        [
            sum_11, sum_12, sum_13, sum_22, sum_23, sum_33, score_1, score_2, score_3
        ] <- this.likelihood_sums;
        [sum_14, sum_24, sum_34, sum_44, score_4] <- this.likelihood_glass;
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
