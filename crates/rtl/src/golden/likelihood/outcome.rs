//! What the model makes of a histogram, and how far that is from a limit at which a status changes.

use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::firmware::likelihood_estimator::{In, LikelihoodEstimator, State};
use tofsim::firmware::tof_top::slot::SlotEstimator;
use tofsim::firmware::tof_top::status::Status;
use tofsim::kernel::U;

use super::kinds::*;

/// Result of a histogram.
#[derive(Default)]
pub(super) struct Outcome {
    /// Score of the first scan.
    start: i64,
    /// Score of the second.
    rescan: i64,
    /// Middle bins of the boxes with these scores.
    middles: [u64; 2],
    /// Shots that wait at the first bin of the check.
    waiting: Option<u64>,
    flags: u64,
    cut: bool,
    status: u64,
}

impl Outcome {
    /// Returns the model's result of a histogram.
    pub(super) fn of(histogram: &[u32], params: &Params) -> Self {
        let (mut block, mut outcome) = (LikelihoodEstimator::default(), Outcome::default());
        for line in 0..=params.done() {
            let memory = &block.likelihood_memory.registers;
            match block.state() {
                State::Start => (outcome.start, outcome.middles[0]) = highest(&block),
                State::Check if memory.word_bin && outcome.waiting.is_none() => {
                    outcome.waiting = Some(memory.word_waiting.get());
                }
                _ => {}
            }
            let word = if memory.read_en { histogram[memory.read_addr.index()] } else { 0 };
            let i =
                In { mode: false, rst: false, algo_start: line == 0, count: U::new(word.into()) };
            block.rise(&i, params);
        }
        (outcome.rescan, outcome.middles[1]) = highest(&block);
        outcome.flags = block.likelihood_solver.registers.flags.get();
        outcome.status = block.registers.status.get();
        outcome.cut = block.likelihood_solver.registers.cut.get() != 0;
        outcome
    }

    /// Returns whether the histogram is of its kind: the status has, or lacks, that one reason.
    pub(super) fn is(&self, kind: u64) -> bool {
        let flags = |which: u64| self.flag(which);
        match kind {
            FAINT => flags(1) && !flags(0) && !flags(2) && (297..425).contains(&self.start),
            AT_END => flags(4),
            AT_BEGIN => flags(3),
            TWO => (332..=425).contains(&self.rescan),
            USED_UP => self.waiting.is_some_and(|waiting| (1..32).contains(&waiting)),
            RISING => flags(6) && !flags(5) && !self.cut,
            ODD => self.status == u64::from(Status::NoFit.bit()),
            UNARMED => self.status == 0,
            FALLING => flags(5) && !flags(6) && !self.cut,
            _ => true,
        }
    }

    /// Returns how far a word is from a limit, if nothing else decides about its reason in the status, and the bin at
    /// which hits change that. On the `far` side the status changes.
    pub(super) fn to_limit(&self, kind: u64, far: bool) -> Option<(u64, u64)> {
        let echo = [0, 1, 2].map(|which| self.flag(which));
        let reason = |status: Status| [0, u64::from(status.bit())].contains(&self.status);
        let no_echo = reason(Status::NoEcho);
        // Hits in the first bins change the shots that wait.
        let waiting = self.waiting.map_or(i64::MAX, |waiting| waiting as i64);
        let (applies, word, limit, bin) = match kind {
            LEAST => (no_echo && echo == [false; 3], self.start, 296, self.middles[0]),
            SURE => (no_echo && echo == [false, true, false], self.start, 424, self.middles[0]),
            ANOTHER => (reason(Status::Another), self.rescan, 331, self.middles[1]),
            WAITS => (true, waiting, 31, 0),
            CERTAIN => (echo == [true, true, false], self.start, 849, self.middles[0]),
            _ => return None,
        };
        applies.then_some((word.abs_diff(limit + i64::from(far)), bin))
    }

    fn flag(&self, which: u64) -> bool {
        self.flags >> which & 1 != 0
    }
}

/// Returns the highest score of a scan, and the middle bin of its box.
fn highest(block: &LikelihoodEstimator) -> (i64, u64) {
    let scan = &block.likelihood_scan.registers;
    (scan.best_score.get(), scan.box_sum.get() / 2)
}
