//! Which part of a run is written to the waveform.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::kernel::Time;

/// A part of a run: `shot:0..8`, `10us..12us` or `estimation`.
///
/// All begin and end with an edge of `clk_sys`. A shot lasts from three cycles before its laser
/// edge (one before `pre_start`) to the next one's, shots counted over the whole run; a window of
/// time is widened to whole cycles; `estimation` is every frame's, from two cycles before
/// `algo_start` to one after `frame_done`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Window {
    /// Shots, the end excluded.
    Shots {
        /// First shot.
        from: u64,
        /// Shot after the last.
        to: u64,
    },
    /// A span of time.
    Span {
        /// Begin.
        from: Time,
        /// End.
        to: Time,
    },
    /// The estimator at work.
    Estimation,
}

/// What a window is decided by, as the coming cycle begins.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Begin and end of the cycle.
    pub cycle: (Time, Time),
    /// Shot under way, over the whole run.
    pub shot: Option<u64>,
    /// The estimator works, is about to or has just finished.
    pub estimating: bool,
}

impl Window {
    /// Whether the coming cycle belongs to it.
    pub fn wants(&self, moment: &Moment) -> bool {
        match *self {
            Window::Shots { from, to } => {
                moment.shot.is_some_and(|shot| (from..to).contains(&shot))
            }
            Window::Span { from, to } => from < moment.cycle.1 && moment.cycle.0 < to,
            Window::Estimation => moment.estimating,
        }
    }

    /// A time that no cycle ends after, of those from `now` on, before [`Window::wants`] can
    /// answer another thing than for the cycle at `now`, whatever the device does.
    pub fn holds_until(&self, now: Time) -> Time {
        match *self {
            Window::Span { from, to } => {
                [from, to].into_iter().find(|&at| now < at).unwrap_or(Time::NEVER)
            }
            Window::Shots { .. } | Window::Estimation => Time::ZERO,
        }
    }

    /// That a run of so many shots and that end reaches the window's end; if not, why.
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
        let expected = "expected `shot:0..8`, `10us..12us` or `estimation`";
        let reversed = |from: &dyn fmt::Display, to: &dyn fmt::Display| {
            Err(format!("reversed or empty: {from} is not before {to}"))
        };
        if text == "estimation" {
            return Ok(Window::Estimation);
        }
        let shots = text.strip_prefix("shot:");
        let (from, to) = shots.unwrap_or(text).split_once("..").ok_or(expected)?;
        if shots.is_some() {
            let number = |text: &str| text.trim().parse::<u64>().map_err(|_| expected.to_owned());
            let (from, to) = (number(from)?, number(to)?);
            return if from < to { Ok(Window::Shots { from, to }) } else { reversed(&from, &to) };
        }
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

/// A number with its unit.
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
    }

    #[test]
    fn a_reversed_or_senseless_window_is_refused() {
        let error = |text: &str| text.parse::<Window>().unwrap_err();
        assert_eq!(error("shot:8..3"), "reversed or empty: 8 is not before 3");
        assert!(error("12us..10us").contains("reversed"));
        for text in ["", "shot", "shot:a..b", "10..12", "-1us..3us", "nanus..3us", "1us"] {
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
