//! How long each part of an estimation takes.

use super::params::Params;
use super::words::{GLASS_STEPS, STEPS};

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
        let steps = (STEPS + if self.glass.bins() > 0 { GLASS_STEPS } else { 0 }) as u64;
        let (program, passes) = (self.program(), steps + 1);
        let programs = program.cycles(program.ambient)
            + program.cycles(program.start)
            + steps * program.cycles(program.step)
            + program.cycles(program.end);
        let states = 1 + 2 + passes;
        self.load_cycles() + 2 * self.scan_cycles() + passes * self.fit_cycles() + programs + states
    }

    /// Cycles of a scan.
    pub fn scan_cycles(&self) -> u64 {
        2 * (self.histogram.bins as u64 + self.scan_tail() + BEATS)
    }

    /// Beats of a fit with a bin or an edge, but for the first.
    fn passed(&self) -> usize {
        let glass = self.glass.bins();
        self.fitted() + if glass > 0 { glass + 1 } else { 0 }
    }

    /// Cycles of a pass over the bins of a fit.
    pub fn fit_cycles(&self) -> u64 {
        2 * (self.passed() as u64 + BEATS)
    }
}
