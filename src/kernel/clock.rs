//! One output of a PLL: an ideal clock whose edges are computed, never accumulated.

use super::time::Time;

/// A clock that is low until its first rising edge at a `phase`.
///
/// Edge `n` is computed from `n`, so that a period which is no whole number of femtoseconds
/// does not drift.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clock {
    half: Half,
    phase: Time,
}

/// Half a period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Half {
    /// A whole number [fs].
    Whole(u64),
    /// Half of that of a frequency [Hz].
    Of(u64),
}

/// A second [fs].
const SECOND_FS: u64 = 1_000_000_000_000_000;

impl Clock {
    /// The clock of that frequency [Hz].
    pub fn new(hz: u64, phase: Time) -> Self {
        if SECOND_FS.is_multiple_of(2 * hz) {
            Clock::of_half(Time::from_fs(SECOND_FS / (2 * hz)), phase)
        } else {
            Clock { half: Half::Of(hz), phase }
        }
    }

    /// The clock with that half of a period.
    pub fn of_half(half: Time, phase: Time) -> Self {
        Clock { half: Half::Whole(half.fs()), phase }
    }

    /// Instant of rising edge `n`, counted from 0.
    #[inline(always)]
    pub fn rise(&self, n: u64) -> Time {
        self.edge(2 * n)
    }

    /// Instant of the falling edge that follows rising edge `n`.
    #[inline(always)]
    pub fn fall(&self, n: u64) -> Time {
        self.edge(2 * n + 1)
    }

    /// Instant of edge `n`, rising and falling counted from 0.
    #[inline(always)]
    pub fn edge(&self, n: u64) -> Time {
        let half_periods = match self.half {
            Half::Whole(half) => n * half,
            Half::Of(hz) => (n as u128 * SECOND_FS as u128 / (2 * hz as u128)) as u64,
        };
        self.phase + Time::from_fs(half_periods)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_period_that_is_not_whole_does_not_drift() {
        let clk = Clock::new(300_000_000, Time::ZERO);
        assert_eq!(clk.rise(1).fs(), 3_333_333);
        assert_eq!(clk.rise(300_000_000), Time::from_ns(1_000_000_000));
    }

    #[test]
    fn the_falling_edge_is_half_a_period_later() {
        let clk = Clock::of_half(Time::from_ns(4), Time::from_ns(10));
        assert_eq!(clk.rise(7), Clock::new(125_000_000, Time::from_ns(10)).rise(7));
        assert_eq!(clk.rise(2), Time::from_ns(26));
        assert_eq!(clk.fall(2), Time::from_ns(30));
        assert_eq!([4, 5].map(|n| clk.edge(n)), [26, 30].map(Time::from_ns));
    }
}
