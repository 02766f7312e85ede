//! Waveform windows: the parts of a run that are written to the waveform.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::kernel::Time;

/// A part of a run: `shot:0..8`, `shot:100` (one shot), `10us..12us` or `estimation`.
///
/// All windows begin and end with an edge of `clk_sys`. A shot lasts from three cycles before its laser edge (one
/// before `pre_start`) to the same point of the next shot; shots are numbered over the whole run. A time window is
/// widened to whole cycles. `estimation` selects every frame from two cycles before `algo_start` to one after
/// `frame_done`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Window {
    /// Range of shots, end excluded.
    Shots {
        /// First shot.
        from: u64,
        /// Shot after the last.
        to: u64,
    },
    /// Range of time.
    Span {
        /// Start.
        from: Time,
        /// End.
        to: Time,
    },
    /// All cycles in which the estimator works.
    Estimation,
}

/// State of the run at the start of a cycle, by which a window selects the cycle.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Start and end of the cycle.
    pub cycle: (Time, Time),
    /// Number of the current shot, over the whole run.
    pub shot: Option<u64>,
    /// Whether the estimator is working, about to start or has just finished.
    pub estimating: bool,
}

impl Window {
    /// Returns whether the window contains the cycle.
    pub fn wants(&self, moment: &Moment) -> bool {
        match *self {
            Window::Shots { from, to } => {
                moment.shot.is_some_and(|shot| (from..to).contains(&shot))
            }
            Window::Span { from, to } => from < moment.cycle.1 && moment.cycle.0 < to,
            Window::Estimation => moment.estimating,
        }
    }

    /// Returns the time until which [`Window::wants`] cannot change, whatever the device does: it is the same for
    /// every cycle that starts at `now` or later and ends by that time.
    pub fn holds_until(&self, now: Time) -> Time {
        match *self {
            Window::Span { from, to } => {
                [from, to].into_iter().find(|&at| now < at).unwrap_or(Time::NEVER)
            }
            Window::Shots { .. } | Window::Estimation => Time::ZERO,
        }
    }

    /// Checks that the window ends within a run of `shots` shots that ends at `end`.
    ///
    /// # Errors
    /// The reason why the window is out of range.
    pub fn check(&self, shots: u64, end: Time) -> Result<(), String> {
        match *self {
            Window::Shots { to, .. } if to > shots => {
                Err(format!("past the end: the run has {shots} shots"))
            }
            Window::Span { to, .. } if to > end => {
                Err(format!("past the end: the run ends at {end}"))
            }
            _ => Ok(()),
        }
    }
}

impl FromStr for Window {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = "expected `shot:0..8`, `shot:100`, `10us..12us` or `estimation`";
        let reversed = |from: &dyn fmt::Display, to: &dyn fmt::Display| {
            Err(format!("reversed or empty: {from} is not before {to}"))
        };
        if text == "estimation" {
            return Ok(Window::Estimation);
        }
        if let Some(shots) = text.strip_prefix("shot:") {
            let number = |text: &str| text.trim().parse::<u64>().map_err(|_| expected.to_owned());
            let (from, to) = match shots.split_once("..") {
                Some((from, to)) => (number(from)?, number(to)?),
                None => (number(shots)?, number(shots)?.saturating_add(1)),
            };
            return if from < to { Ok(Window::Shots { from, to }) } else { reversed(&from, &to) };
        }
        let (from, to) = text.split_once("..").ok_or(expected)?;
        let (from, to) = (time(from).ok_or(expected)?, time(to).ok_or(expected)?);
        if from < to { Ok(Window::Span { from, to }) } else { reversed(&from, &to) }
    }
}

impl TryFrom<String> for Window {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Window> for String {
    fn from(window: Window) -> Self {
        window.to_string()
    }
}

/// Parses a non-negative number with a unit of time.
fn time(text: &str) -> Option<Time> {
    const UNITS: &[(&str, f64)] =
        &[("ps", 1.0), ("ns", 1e3), ("us", 1e6), ("ms", 1e9), ("s", 1e12)];
    let text = text.trim();
    let (number, ps) = UNITS.iter().find_map(|(unit, ps)| Some((text.strip_suffix(unit)?, ps)))?;
    let number: f64 = number.trim().parse().ok()?;
    let ps = number * ps;
    (0.0..=1e16).contains(&ps).then(|| Time::from_ps_f64(ps))
}

impl fmt::Display for Window {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Window::Shots { from, to } => write!(f, "shot:{from}..{to}"),
            Window::Span { from, to } => {
                write!(f, "{}us..{}us", from.fs() as f64 / 1e9, to.fs() as f64 / 1e9)
            }
            Window::Estimation => write!(f, "estimation"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_read_and_written_alike() {
        for text in ["shot:0..8", "10us..12.5us", "estimation"] {
            assert_eq!(text.parse::<Window>().unwrap().to_string(), text);
        }
        let span = Window::Span { from: Time::from_ns(10), to: Time::from_ns(2_000_000) };
        assert_eq!("10ns..2ms".parse(), Ok(span));
        assert_eq!("shot:100".parse(), Ok(Window::Shots { from: 100, to: 101 }));
    }

    #[test]
    fn a_reversed_or_senseless_window_is_refused() {
        let error = |text: &str| text.parse::<Window>().unwrap_err();
        assert_eq!(error("shot:8..3"), "reversed or empty: 8 is not before 3");
        assert!(error("12us..10us").contains("reversed"));
        for text in
            ["", "shot", "shot:", "shot:x", "shot:a..b", "10..12", "-1us..3us", "nanus..3us", "1us"]
        {
            assert!(error(text).contains("expected"), "{text}");
        }
    }

    #[test]
    fn a_window_of_time_is_widened_to_whole_cycles() {
        let window: Window = "10ns..20ns".parse().unwrap();
        let wants = |from, to| {
            let cycle = (Time::from_ns(from), Time::from_ns(to));
            window.wants(&Moment { cycle, shot: None, estimating: false })
        };
        assert!(!wants(0, 8) && wants(8, 16) && wants(16, 24) && !wants(24, 32));
    }

    #[test]
    fn an_answer_holds_for_every_cycle_that_ends_before_the_next_bound_of_a_span() {
        let window: Window = "13ns..40ns".parse().unwrap();
        let cycle = |nth: u64| (Time::from_ns(8 * nth), Time::from_ns(8 * nth + 8));
        let wants =
            |nth| window.wants(&Moment { cycle: cycle(nth), shot: None, estimating: false });
        let held_to = [Some(0), None, Some(4), Some(4), Some(4), Some(8), Some(8), Some(8)];
        for (first, expected) in (0..).zip(held_to) {
            let until = window.holds_until(cycle(first).0);
            let held: Vec<_> = (first..9).take_while(|&nth| cycle(nth).1 <= until).collect();
            assert!(held.iter().all(|&nth| wants(nth) == wants(first)), "from cycle {first}");
            assert_eq!(held.last().copied(), expected, "from cycle {first}");
        }
    }
}
