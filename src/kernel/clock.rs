//! One output of a PLL: an ideal clock whose edges are computed, never accumulated.

use super::time::Time;

/// A clock of `reference_hz * multiply / divide`, low until its first rising edge at `phase`.
///
/// Edge `n` is computed from `n`, so that a period which is no whole number of femtoseconds
/// does not drift.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clock {
    period_numerator: u128,
    period_denominator: u128,
    /// Half a period, if that is a whole number [fs].
    whole_half: Option<u64>,
    phase: Time,
}

impl Clock {
    /// The clock with its first rising edge at `phase`.
    pub fn new(reference_hz: u64, multiply: u64, divide: u64, phase: Time) -> Self {
        let period_numerator = divide as u128 * 1_000_000_000_000_000;
        let period_denominator = reference_hz as u128 * multiply as u128;
        let is_whole = period_numerator.is_multiple_of(2 * period_denominator);
        let whole_half = is_whole.then_some((period_numerator / (2 * period_denominator)) as u64);
        Clock { period_numerator, period_denominator, whole_half, phase }
    }

    /// Instant of rising edge `n`, counted from 0.
    #[inline(always)]
    pub fn rise(&self, n: u64) -> Time {
        self.phase + self.half_periods(2 * n)
    }

    /// Instant of the falling edge that follows rising edge `n`.
    #[inline(always)]
    pub fn fall(&self, n: u64) -> Time {
        self.phase + self.half_periods(2 * n + 1)
    }

    /// The period, if half of it is a whole number of femtoseconds.
    pub fn whole_period(&self) -> Option<Time> {
        self.whole_half.map(|half| Time::from_fs(2 * half))
    }

    #[inline(always)]
    fn half_periods(&self, count: u64) -> Time {
        Time::from_fs(match self.whole_half {
            Some(half) => count * half,
            None => (count as u128 * self.period_numerator / (2 * self.period_denominator)) as u64,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_period_that_is_not_whole_does_not_drift() {
        let clk = Clock::new(100_000_000, 3, 1, Time::ZERO);
        assert_eq!(clk.rise(1).fs(), 3_333_333);
        assert_eq!(clk.rise(300_000_000), Time::from_ns(1_000_000_000));
    }

    #[test]
    fn the_falling_edge_is_half_a_period_later() {
        let clk = Clock::new(200_000_000, 5, 8, Time::from_ns(10));
        assert_eq!(clk.rise(2), Time::from_ns(26));
        assert_eq!(clk.fall(2), Time::from_ns(30));
    }
}
