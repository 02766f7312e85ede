//! Comparison of pairs with a latency or a valid signal, which needs more than the values of one sample.

use std::collections::VecDeque;

use tofsim::error::Result;

use crate::source::SourceState;

use super::differences::{Differences, Spot};
use super::plan::Plan;
use crate::words::Bits;

/// State of a pair with a latency or a valid signal.
pub(super) struct Delay {
    pair: usize,
    early: VecDeque<Entry>,
}

/// A sample that waits for the later side.
#[derive(Clone)]
struct Entry {
    values: [Bits; 2],
    spot: Spot,
    /// Whether each side excludes the sample from the comparison.
    off: [bool; 2],
}

impl Delay {
    /// Creates the state of a pair.
    pub(super) fn new(pair: usize) -> Self {
        Delay { pair, early: VecDeque::new() }
    }

    /// Discards all waiting samples, at the start of a window.
    pub(super) fn clear(&mut self) {
        self.early.clear();
    }

    /// Stores the values of a sample, some of which may be missing, and compares as soon as both sides are present.
    pub(super) fn compare(
        &mut self,
        plan: &Plan,
        spot: Spot,
        states: [&SourceState; 2],
        gaps: [bool; 2],
        differences: &mut Differences,
    ) -> Result<()> {
        let pair = &plan.matching.pairs[self.pair];
        let mut values = [Bits::default(), Bits::default()];
        pair.gather_both(states, &mut values);
        let off = [gaps[0] || pair.is_off(states[0]), gaps[1]];
        let now = Entry { values, spot, off };
        self.early.push_back(now.clone());
        let has_come = self.early.len() as u64 > pair.latency.unsigned_abs();
        let Some(early) = has_come.then(|| self.early.pop_front()).flatten() else {
            return differences.show(self.pair, states, false);
        };
        let [a, b] = if pair.latency >= 0 { [&early, &now] } else { [&now, &early] };
        if a.off[0] || b.off[1] {
            return differences.show(self.pair, states, false);
        }
        let (expected, got) = (&a.values[0], &b.values[1]);
        let differs = !pair.equal(expected, got, differences.unknowns);
        let count = &mut differences.counts[self.pair];
        count.compared += 1;
        if differs {
            let at = [a.spot.at[0], b.spot.at[1]];
            count.differs(pair, Spot { at, ..now.spot }, expected, got);
        }
        differences.show(self.pair, states, differs)
    }
}
