//! Sampling clock of a logic analyser.

use std::fmt;
use std::str::FromStr;

use tofsim::firmware::pll::Pll;
use tofsim::kernel::Time;
use tofsim::kernel::clock::Clock;

/// A clock of the design, or a free-running clock.
#[derive(Clone, Debug, PartialEq)]
pub enum AnalyserClock {
    /// `clk_sys`.
    System,
    /// `clk_laser`.
    Laser,
    /// `clk_in`.
    Input,
    /// A clock independent of the design.
    Free {
        /// Frequency [Hz].
        frequency_hz: u64,
        /// Time of the first rising edge after power-up.
        phase: Time,
    },
}

/// Frequency range of a free-running clock [Hz].
const RANGE: std::ops::RangeInclusive<f64> = 1e3..=1e9;

impl AnalyserClock {
    /// Returns the rising edges of the clock, without jitter.
    pub fn clock(&self, pll: &Pll) -> Clock {
        match self {
            AnalyserClock::System => pll.clk_sys.clone(),
            AnalyserClock::Laser => pll.clk_laser.clone(),
            AnalyserClock::Input => pll.clk_in.clone(),
            AnalyserClock::Free { frequency_hz, phase } => Clock::new(*frequency_hz, *phase),
        }
    }
}

impl FromStr for AnalyserClock {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        const EXPECTED: &str = "expected clk_sys, clk_laser, clk_in, or a frequency from 1 kHz to \
            1 GHz with the time of the first edge, such as 100MHz or 62.5 MHz + 250 ps";
        match text.trim() {
            "clk_sys" => return Ok(AnalyserClock::System),
            "clk_laser" => return Ok(AnalyserClock::Laser),
            "clk_in" => return Ok(AnalyserClock::Input),
            _ => {}
        }
        let (frequency, phase) = text.split_once('+').unwrap_or((text, "0ps"));
        let units = [("kHz", 1e3), ("MHz", 1e6), ("GHz", 1e9), ("Hz", 1.0)];
        let frequency_hz = quantity(frequency, &units).ok_or(EXPECTED)?;
        let phase_ps = quantity(phase, &[("ps", 1.0), ("ns", 1e3), ("us", 1e6)]);
        let phase_ps = phase_ps.filter(|ps| (0.0..=1e12).contains(ps)).ok_or(EXPECTED)?;
        if !RANGE.contains(&frequency_hz) || frequency_hz.fract() != 0.0 {
            return Err(EXPECTED);
        }
        let phase = Time::from_ps_f64(phase_ps);
        Ok(AnalyserClock::Free { frequency_hz: frequency_hz as u64, phase })
    }
}

/// Parses a number with one of the given units, and returns it times the unit's factor.
pub(crate) fn quantity(text: &str, units: &[(&str, f64)]) -> Option<f64> {
    let text = text.trim();
    let split = |(unit, factor): &(&str, f64)| Some((text.strip_suffix(unit)?, *factor));
    let (number, factor) = units.iter().find_map(split)?;
    Some(number.trim_end().parse::<f64>().ok()? * factor)
}

impl fmt::Display for AnalyserClock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AnalyserClock::System => f.write_str("clk_sys"),
            AnalyserClock::Laser => f.write_str("clk_laser"),
            AnalyserClock::Input => f.write_str("clk_in"),
            AnalyserClock::Free { frequency_hz, phase } => {
                write!(f, "{frequency_hz} Hz + {} ps", phase.fs() as f64 / 1e3)
            }
        }
    }
}

/// Returns the number of the first edge at or after `time`.
pub fn first_edge(clock: &Clock, time: Time) -> u64 {
    let mut range = 0..1;
    while clock.rise(range.end) < time {
        range.end *= 2;
    }
    while range.start < range.end {
        let middle = range.start.midpoint(range.end);
        if clock.rise(middle) < time { range.start = middle + 1 } else { range.end = middle }
    }
    range.start
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_is_one_of_the_design_s_or_a_frequency_with_a_phase() {
        let free =
            |frequency_hz, fs| AnalyserClock::Free { frequency_hz, phase: Time::from_fs(fs) };
        for (text, sampling) in [
            ("clk_sys", AnalyserClock::System),
            ("100MHz", free(100_000_000, 0)),
            ("62.5 MHz + 250 ps", free(62_500_000, 250_000)),
            ("1 GHz+1.5ns", free(1_000_000_000, 1_500_000)),
        ] {
            assert_eq!(text.parse(), Ok(sampling.clone()), "{text}");
            assert_eq!(sampling.to_string().parse(), Ok(sampling), "{text}");
        }
        for text in ["", "clk_100", "100", "MHz", "nan Hz", "1.5 Hz", "2 GHz", "1MHz + -1 ps"] {
            assert!(text.parse::<AnalyserClock>().is_err(), "{text}");
        }
    }

    #[test]
    fn the_first_edge_is_the_one_at_that_time_or_the_next() {
        let clock = Clock::new(125_000_000, Time::from_ns(8));
        for (ns, edge) in [(0, 0), (8, 0), (9, 1), (16, 1), (8_000_001, 1_000_000)] {
            assert_eq!(first_edge(&clock, Time::from_ns(ns)), edge, "{ns}");
        }
        let slow = Clock::new(1000, Time::ZERO);
        assert_eq!(first_edge(&slow, Time::from_ns(1_000_000_000_000)), 1_000_000);
    }
}
