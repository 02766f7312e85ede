//! How long each part of an estimation takes.

use crate::firmware::likelihood_solver::program::{
    AMBIENT_PROGRAM, END_PROGRAM, START_PROGRAM, STEP_PROGRAM, program_cycles,
};

use super::params::Params;
use super::words::STEPS;

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
