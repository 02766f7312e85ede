//! How long each part of an estimation takes.

use super::params::Params;
use super::targets::TURNS;
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
        let one = self.load_cycles()
            + 2 * self.scan_cycles()
            + passes * self.fit_cycles()
            + programs
            + states;
        if self.has_second() { one + self.second_cycles() } else { one }
    }

    /// What a second target takes: a scan, the begin of it and a check without its light, the results of either echo
    /// beside those of one, a pass and a step of each in turn, and longer checks [cycles of clk_sys].
    fn second_cycles(&self) -> u64 {
        let (program, turns) = (self.program(), TURNS as u64);
        let turn =
            program.cycles(program.swap) + self.pair_cycles() + program.cycles(program.step) + 1;
        self.scan_cycles()
            + 1
            + program.cycles(program.second)
            + self.pair_cycles()
            + 1
            + turns * turn
            + 2 * program.cycles(program.end)
            + (self.pair_cycles() - self.fit_cycles())
    }

    /// Cycles of a pass over the bins of both echoes.
    pub fn pair_cycles(&self) -> u64 {
        self.fit_cycles() + 2 * (self.fitted() as u64 + 1)
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
