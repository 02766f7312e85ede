//! The board's oscillator, which only waveforms show.

use crate::kernel::Time;
use crate::kernel::clock::Clock;

/// `clk_in` over time.
#[derive(Clone, Debug)]
pub struct Oscillator {
    clock: Clock,
    /// Next edge, rising and falling counted.
    next: u64,
    at: Time,
}

impl Oscillator {
    /// An oscillator at power-up.
    pub fn new(clock: Clock) -> Self {
        Oscillator { at: clock.rise(0), clock, next: 0 }
    }

    /// Returns the instant of the next edge.
    #[inline(always)]
    pub fn next_edge(&self) -> Time {
        self.at
    }

    /// Takes an edge; returns the level after it.
    #[inline(always)]
    pub fn edge(&mut self) -> bool {
        self.go_to(self.next + 1)
    }

    /// Advances to `now`, after an edge at that instant; returns the level.
    pub fn seek(&mut self, now: Time) -> bool {
        // The first edge is half a period after power-up.
        let mut next = now.fs() / self.clock.rise(0).fs();
        while next > 0 && self.clock.edge(next - 1) > now {
            next -= 1;
        }
        while self.clock.edge(next) <= now {
            next += 1;
        }
        self.go_to(next)
    }

    #[inline(always)]
    fn go_to(&mut self, next: u64) -> bool {
        (self.next, self.at) = (next, self.clock.edge(next));
        next % 2 == 1
    }
}
