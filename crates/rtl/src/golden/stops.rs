//! The changes of `tdc_stop` in a stimulus, in step with the clock of a bench.

use tofsim::firmware::carry_chain::{Delays, Taps, Transitions};
use tofsim::kernel::Time;

use super::draw::Draw;

/// Planned changes of `tdc_stop`, and how many of them have happened.
#[derive(Clone, Debug)]
pub struct Stops {
    /// Period of the clock.
    pub cycle: Time,
    transitions: Transitions,
    times: Vec<Time>,
    applied: usize,
}

impl Stops {
    /// Nothing is planned yet, where the clock has that period.
    pub fn new(cycle: Time) -> Self {
        Stops { cycle, transitions: Transitions::default(), times: Vec::new(), applied: 0 }
    }

    /// Instant of the edge that ends a line.
    pub fn edge(&self, line: usize) -> Time {
        Time::from_fs(self.cycle.fs() * (line as u64 + 1))
    }

    /// All changes, in order.
    pub fn times(&self) -> &[Time] {
        &self.times
    }

    /// Plans a change, after the last one.
    pub fn toggle(&mut self, at: Time) {
        if self.times.last().is_none_or(|last| *last < at) {
            self.times.push(at);
        }
    }

    /// When the last change planned happens.
    pub fn last(&self) -> Time {
        self.times.last().copied().unwrap_or_default()
    }

    /// Returns whether the level is high after all that is planned.
    pub fn ends_high(&self) -> bool {
        self.times.len() % 2 == 1
    }

    /// Lets what is planned up to and at `now` come to pass.
    pub fn advance(&mut self, now: Time) {
        while self.times.get(self.applied).is_some_and(|at| *at <= now) {
            self.transitions.push(self.times[self.applied]);
            self.applied += 1;
        }
    }

    /// Returns the level of `tdc_stop`.
    pub fn level(&self) -> bool {
        self.applied % 2 == 1
    }

    /// Samples the taps of a chain at an edge.
    pub fn sample(&mut self, now: Time, delays: &Delays) -> Taps {
        self.transitions.sample(self.level(), now, delays)
    }

    /// An instant before the edge at `edge`: such that a tap is reached exactly then, or 1 fs beside
    /// that, or the edge itself, or any within the last two periods.
    pub fn before(&self, edge: Time, delays: &Delays, draw: &mut Draw) -> Time {
        let arrivals = delays.arrivals();
        let age = match draw.below(4) {
            0 => 0,
            1 => draw.below(2 * self.cycle.fs()),
            _ => arrivals[draw.below(arrivals.len() as u64) as usize].fs() + draw.below(3) - 1,
        };
        edge.since(Time::from_fs(age))
    }
}

/// Returns a number of eighths of a clock period: nanoseconds on the KC705.
pub fn of_eighths(eighths: u64, cycle: Time) -> Time {
    Time::from_fs(eighths * cycle.fs() / 8)
}
