//! Simulated time.

use std::fmt;
use std::ops::{Add, AddAssign, Sub};

/// An instant since power-up, or the span between two instants [fs].
///
/// Integer femtoseconds in 64 bits reach five hours, and no sum of them rounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Time(u64);

impl Time {
    /// Power-up.
    pub const ZERO: Time = Time(0);
    /// Later than every event.
    pub const NEVER: Time = Time(u64::MAX);

    /// A count of femtoseconds.
    pub const fn from_fs(fs: u64) -> Self {
        Time(fs)
    }

    /// A count of whole nanoseconds.
    pub const fn from_ns(ns: u64) -> Self {
        Time(ns * 1_000_000)
    }

    /// A physical quantity in picoseconds, rounded to the nearest femtosecond; negative is zero.
    pub fn from_ps_f64(ps: f64) -> Self {
        Time((ps * 1e3).round() as u64)
    }

    /// Returns the time in femtoseconds [fs].
    pub const fn fs(self) -> u64 {
        self.0
    }

    /// Returns the time in whole picoseconds, rounded down, as waveform files have it [ps].
    pub const fn ps(self) -> u64 {
        self.0 / 1000
    }

    /// Returns the time in seconds, for physics and for people [s].
    pub fn seconds(self) -> f64 {
        self.0 as f64 * 1e-15
    }

    /// The span from `earlier` to here, or zero if `earlier` is later.
    pub const fn since(self, earlier: Time) -> Time {
        Time(self.0.saturating_sub(earlier.0))
    }

    /// The sum, or [`Time::NEVER`] past the end of representable time.
    pub const fn saturating_add(self, span: Time) -> Time {
        Time(self.0.saturating_add(span.0))
    }
}

impl Add for Time {
    type Output = Time;
    fn add(self, span: Time) -> Time {
        Time(self.0 + span.0)
    }
}

impl AddAssign for Time {
    fn add_assign(&mut self, span: Time) {
        *self = *self + span;
    }
}

impl Sub for Time {
    type Output = Time;
    fn sub(self, earlier: Time) -> Time {
        Time(self.0 - earlier.0)
    }
}

impl fmt::Display for Time {
    /// Microseconds with as many digits as the value needs.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} us", self.0 as f64 / 1e9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waveform_time_is_rounded_down() {
        assert_eq!(Time::from_fs(1_999).ps(), 1);
        assert_eq!(Time::from_ns(8).ps(), 8_000);
    }

    #[test]
    fn a_negative_physical_time_is_power_up() {
        assert_eq!(Time::from_ps_f64(-3.0), Time::ZERO);
        assert_eq!(Time::from_ps_f64(2.0004).fs(), 2_000);
    }
}
