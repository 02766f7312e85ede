//! What the model makes of a histogram, and how far that is from a limit at which a status changes.

use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::firmware::tof_top::status::Status;
use tofsim::sim::estimates::likelihood::trace;

use super::kinds::*;

/// Result of a histogram.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Outcome {
    /// Score of the first scan.
    start: i64,
    /// Score of the second.
    rescan: i64,
    /// Middle bins of the boxes with these scores.
    middles: [u64; 2],
    /// Shots that wait at the first bin of the check.
    waiting: Option<u64>,
    /// The solver's flags.
    flags: [bool; 7],
    /// The last step was shortened.
    cut: bool,
    status: u64,
}

impl Outcome {
    /// Returns the model's result of a histogram: without a clock, because a search looks at thousands.
    pub(super) fn of(histogram: &[u32], params: &Params) -> Self {
        let trace = trace(params, histogram);
        let middle = |(from, until): (usize, usize)| (from + until) as u64 / 2;
        Outcome {
            start: trace.start.score,
            rescan: trace.other.score,
            middles: [trace.start, trace.other].map(|best| middle(best.bins)),
            waiting: trace.waiting.map(|shots| shots as u64),
            flags: trace.flags,
            cut: trace.steps.last().is_some_and(|(_, information)| information.cut > 0),
            status: trace.found.status.bits().into(),
        }
    }

    /// Returns whether the histogram is of its kind: the status has, or lacks, that one reason.
    pub(super) fn is(&self, kind: u64) -> bool {
        let flags = self.flags;
        match kind {
            FAINT => flags[..3] == [false, true, false] && (297..425).contains(&self.start),
            AT_END => flags[4],
            AT_BEGIN => flags[3],
            TWO => (332..=425).contains(&self.rescan),
            USED_UP => self.waiting.is_some_and(|waiting| (1..32).contains(&waiting)),
            RISING => flags[6] && !flags[5] && !self.cut,
            ODD => self.status == u64::from(Status::NoFit.bit()),
            UNARMED => self.status == 0,
            FALLING => flags[5] && !flags[6] && !self.cut,
            _ => true,
        }
    }

    /// Returns how far a word is from a limit, if nothing else decides about its reason in the status, and the bin at
    /// which hits change that. On the `far` side the status changes.
    pub(super) fn to_limit(&self, kind: u64, far: bool) -> Option<(u64, u64)> {
        let echo = &self.flags[..3];
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
}

#[cfg(test)]
mod tests;
