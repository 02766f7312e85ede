//! Result of a shot's first avalanche as a function of its time from the laser edge.
//!
//! In MODE 0 a shot has at most one avalanche, so that its result depends on that time alone, as long as nothing of
//! the previous shot is left in the chain: a staircase whose steps are the spans of [`Bins`] and the gaps between and
//! after them.

use crate::firmware::histogram_builder::MOST_BINS;
use crate::firmware::tdc;
use crate::kernel::Time;
use crate::optics::Bins;

/// Result of a shot: a code, or one of the constants here.
pub type ShotOutcome = u16;

/// The TDC keeps the hit, but it has no code.
pub const NO_CODE: ShotOutcome = MOST_BINS as ShotOutcome;

/// The TDC sees nothing.
pub const NO_HIT: ShotOutcome = NO_CODE + 1;

/// Number of outcomes.
pub const OUTCOMES: usize = MOST_BINS + 2;

/// From the last edge whose hits may have codes to the next laser edge at least, so that the TDC has kept
/// them by then: a leap counts what it has kept, however far it is from its word [cycles of clk_sys].
const TO_KEEP: u64 = 2;

/// Outcomes as a staircase over time.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotOutcomes {
    /// Begin of each step, the first one 0, and its outcome; neighbours differ.
    steps: Vec<(Time, ShotOutcome)>,
    /// End of the hits, and that in the last shot of a frame.
    ends: [Time; 2],
}

impl ShotOutcomes {
    /// Outcomes of shots that follow each other after `period` cycles.
    ///
    /// The last shot of a frame differs: no reset ends it, so that its window lasts to its end.
    ///
    /// `None` where a shot is not independent of the one before: if that one's pulse, which ends a
    /// cycle before the laser edge, may still be in the chain at the edge after it, or its code may
    /// come too late.
    pub fn new(p: &tdc::Params, period: u64) -> Option<Self> {
        let (tap_0, cycle) = (p.delays.tap_0(), p.decoder.scale.period());
        // First time of an avalanche that an edge is too early for.
        let end = |edge: u64| Time::from_fs(edge * cycle.fs() + 1).since(tap_0);
        let bins = Bins::of_tdc(p);
        let coded = bins.spans().last().map_or(Time::ZERO, |span| span.until);
        if tap_0 > cycle
            || p.delays.longest() > cycle + cycle
            || coded > end(period.saturating_sub(TO_KEEP))
        {
            return None;
        }
        let window = p.coarse_counter.window();
        let ends = [end(window.min(period - 1)), end(window)];
        let mut outcomes = ShotOutcomes { steps: vec![(Time::ZERO, NO_CODE)], ends };
        for span in bins.spans() {
            outcomes.step(span.from, span.code);
            outcomes.step(span.until, NO_CODE);
        }
        outcomes.step(ends[0], NO_HIT);
        Some(outcomes)
    }

    /// Returns the outcome of an avalanche `arrival` after the laser edge.
    pub fn of(&self, arrival: Time) -> ShotOutcome {
        let next = self.steps.partition_point(|&(begin, _)| begin <= arrival);
        self.steps[next - 1].1
    }

    /// Returns begin and outcome of each step, in order of time.
    pub fn steps(&self) -> &[(Time, ShotOutcome)] {
        &self.steps
    }

    /// Returns the time from which on every hit is lost and before which none is, and that of the last shot of a frame.
    pub fn ends(&self) -> [Time; 2] {
        self.ends
    }

    /// Adds a step to `outcome` at `begin`, which is not before the last step's.
    fn step(&mut self, begin: Time, outcome: ShotOutcome) {
        if self.steps.last().is_some_and(|last| last.0 == begin) {
            self.steps.pop();
        }
        if self.steps.last().is_none_or(|last| last.1 != outcome) {
            self.steps.push((begin, outcome));
        }
    }
}
