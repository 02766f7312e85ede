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

use crate::kernel::{S, U};
use crate::{connect, signals, states};

mod duration;
pub mod glass;
pub mod params;
pub mod pipeline;
pub mod pulse;
mod sequence;
mod slotted;
pub mod tables;
pub mod targets;
mod turns;
mod unfit;
pub mod words;

use super::forward2::Depth;
use super::likelihood_glass::{self, LikelihoodGlass};
use super::likelihood_memory::{self, LikelihoodMemory, Place};
use super::likelihood_pair::{self, LikelihoodPair};
use super::likelihood_scan::{self, LikelihoodScan};
use super::likelihood_solver::{self, LikelihoodSolver};
use super::likelihood_sums::{self, LikelihoodSums};
use super::likelihood_terms::{self, LikelihoodTerms};

pub use super::tof_top::slot::SlotIn as In;
use super::tof_top::status_code::StatusCode;

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
        /// Computes the begin of the other echo.
        Second,
        /// Puts the echoes in each other's place.
        Swap,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Registers {
        /// The depth, when `algo_done` is high, and until the next one [m].
        pub depth: Depth,
        /// Its standard deviation [2^-29 m].
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
        /// What a host can rely on.
        #[view(heading = "Estimator", probe = true)]
        pub code: StatusCode,
        /// The depth is ready; one cycle.
        pub algo_done: bool,
        /// Depth of the second target, 0 without one [m].
        #[only_if(HasSecond)]
        pub second_depth: Depth,
        /// Its standard deviation [2^-29 m].
        #[only_if(HasSecond)]
        #[view(heading = "Estimator", probe = true)]
        pub second_sigma: U<36>,
        /// Its signal, 14 fraction bits [photons a shot].
        #[only_if(HasSecond)]
        #[view(heading = "Estimator", probe = true)]
        pub second_strength: U<24>,
        /// Reasons to reject its depth, as of [`Status`].
        #[only_if(HasSecond)]
        #[view(heading = "Estimator", probe = true)]
        pub second_status: U<7>,
        /// There is a second target, and its status says nothing against its depth.
        #[only_if(HasSecond)]
        pub second_valid: bool,
        /// State of the computation.
        #[view(heading = "Likelihood", probe = true)]
        pub(crate) state: State,
        /// Cycles in this state.
        #[size(WaitBits)]
        pub(crate) waited: U<14>,
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
        #[only_if(MoreLight)]
        pub(crate) dark: bool,
        /// The check has come to the window around the echo.
        #[only_if(Glass)]
        pub(crate) reached: bool,
        /// `mode` was high since the last estimation began.
        pub(crate) free: bool,
        /// The same of the shots of this estimation.
        pub(crate) unarmed: bool,
        /// A pass goes over the bins around both echoes.
        #[only_if(HasSecond)]
        pub(crate) wide: bool,
        /// Both echoes have light.
        #[only_if(HasSecond)]
        pub(crate) paired: bool,
        /// Steps taken of both.
        #[only_if(HasSecond)]
        #[view(heading = "Likelihood", probe = true)]
        pub(crate) turns: U<4>,
        /// The other echo's bins are the earlier ones.
        #[only_if(HasSecond)]
        pub(crate) behind: bool,
        /// Begin of the later bins of a fit [bins].
        #[only_if(HasSecond)]
        #[size(PlaceBits)]
        pub(crate) later_begin: Place,
        /// Their end.
        #[only_if(HasSecond)]
        #[size(PlaceBits)]
        pub(crate) later_end: Place,
        /// The check has come to the later bins.
        #[only_if(HasSecond)]
        pub(crate) later_reached: bool,
        /// One of them has come.
        #[only_if(HasSecond)]
        pub(crate) later_seen: bool,
        /// Few shots waited at the first.
        #[only_if(HasSecond)]
        pub(crate) later_used_up: bool,
        /// Score of the box over one echo.
        #[only_if(HasSecond)]
        pub(crate) alone_score: likelihood_scan::Log,
        /// Depth of one echo [m].
        #[only_if(HasSecond)]
        pub(crate) alone_depth: S<36, 29>,
        /// Its deviation [2^-29 m].
        #[only_if(HasSecond)]
        pub(crate) alone_sigma: U<36>,
        /// Flags of one echo.
        #[only_if(HasSecond)]
        pub(crate) alone_flags: U<7>,
        /// Its last step was shortened.
        #[only_if(HasSecond)]
        pub(crate) alone_cut: bool,
        /// The cover glass's light has changed, as one echo has it.
        #[only_if(HasSecond)]
        pub(crate) alone_changed: bool,
        /// Chi-square of one echo over the bins of both.
        #[only_if(HasSecond)]
        #[size(ChiBits)]
        pub(crate) alone_chi: U<35>,
        /// A bin is far from it.
        #[only_if(HasSecond)]
        pub(crate) alone_far: bool,
        /// Few shots waited at its first bin.
        #[only_if(HasSecond)]
        pub(crate) alone_used_up: bool,
        /// Depth of the other of two echoes [m].
        #[only_if(HasSecond)]
        pub(crate) other_depth: S<36, 29>,
        /// Its deviation [2^-29 m].
        #[only_if(HasSecond)]
        pub(crate) other_sigma: U<36>,
        /// Flags of the other echo.
        #[only_if(HasSecond)]
        pub(crate) other_flags: U<7>,
        /// Its last step was shortened.
        #[only_if(HasSecond)]
        pub(crate) other_cut: bool,
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
    /// The other echo.
    pub likelihood_pair: LikelihoodPair,
    /// The box.
    pub likelihood_scan: LikelihoodScan,
    /// Arithmetic.
    pub likelihood_solver: LikelihoodSolver,
}

connect! {
    /// Port connections.
    pub struct Wires in likelihood_estimator (this: &LikelihoodEstimator, i: &In) {
        signals registers;
        output [read_en, read_addr] <- this.likelihood_memory.registers;
    }
    likelihood_memory(clk_sys): likelihood_memory::In {
        rst <- i.rst;
        load <- this.registers.load;
        [depth_column, count] <- i;
        [pass, scan, fit_begin, fit_end, wide, later_begin, later_end, phase] <- this.registers;
    }
    likelihood_terms(clk_sys): likelihood_terms::In {
        [phase, scan, dark] <- this.registers;
        glass_light <- this.likelihood_glass.glass_light;
        other_light <- this.likelihood_pair.other_light;
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
        paired <- this.registers.paired;
        still_share <- this.likelihood_pair.still_share;
    }
    likelihood_pair(clk_sys): likelihood_pair::In {
        pass <- this.registers.sums;
        [phase, paired] <- this.registers;
        [other_arrival, other_strength] <- this.likelihood_solver.registers;
        [word_bin, word_edge, word_first, word_end] <- this.likelihood_memory.registers;
        glass_light <- this.likelihood_glass.glass_light;
        [ambient_light, hazard_bits, hazard_reciprocal, residual, share, slope] <- this.likelihood_terms;
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
        paired <- this.registers.paired;
        [still_13, still_23, still_33, still_score] <- this.likelihood_pair;
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
