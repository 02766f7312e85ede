//! Which sample of one side belongs to which of the other.

mod correlation;
mod edge;
mod survey;
mod trigger;
mod windows;

use std::str::FromStr;

use tofsim::error::{Input, Result};
use tofsim::kernel::Time;

use super::plan::Plan;
use super::samples::time;
use super::selection::Piece;

pub use survey::{Survey, survey};

/// How the sides are brought together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Align {
    /// The first samples belong together; of waveforms those of the same time.
    Start,
    /// The samples that triggered belong together.
    Trigger,
    /// The first edges of a signal belong together.
    Edge(String),
    /// Where the sides agree best in those signals, or in all.
    Correlation(Vec<String>),
    /// The same for each window alone.
    Windows(Vec<String>),
    /// The second side is so many samples late.
    Offset(i64),
    /// The second side is that much late.
    Shift {
        /// How much.
        by: Time,
        /// It is early instead.
        early: bool,
    },
}

impl FromStr for Align {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let (word, rest) = text.split_once([' ', ':']).unwrap_or((text, ""));
        let rest = rest.trim();
        let list = || rest.split(',').map(|name| name.trim().to_owned()).collect::<Vec<_>>();
        let names = || if rest.is_empty() { Vec::new() } else { list() };
        match word {
            "start" if rest.is_empty() => Ok(Align::Start),
            "trigger" if rest.is_empty() => Ok(Align::Trigger),
            "edge" if !rest.is_empty() => Ok(Align::Edge(rest.to_owned())),
            "correlation" => Ok(Align::Correlation(names())),
            "windows" => Ok(Align::Windows(names())),
            "offset" => {
                if let Ok(samples) = rest.parse() {
                    return Ok(Align::Offset(samples));
                }
                let (early, size) = match rest.strip_prefix('-') {
                    Some(size) => (true, size),
                    None => (false, rest),
                };
                let by = time(size).ok_or("expected samples or a time, as `offset 8ns`")?;
                Ok(Align::Shift { by, early })
            }
            _ => Err("expected start, trigger, edge SIGNAL, correlation, windows, offset N or \
                offset 8ns"
                .to_owned()),
        }
    }
}

/// Samples that belong together: piece by piece, one by one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Alignment {
    /// The pieces of each side.
    pub(super) pieces: [Vec<Piece>; 2],
    /// How they were found.
    pub(super) found: String,
    /// Samples that the second side is later, if it is one number.
    pub(super) offset: Option<i64>,
    /// What is different already.
    pub(super) differences: Vec<String>,
}

impl Alignment {
    /// One piece on each side, the second `offset` samples later.
    fn shifted(offset: i64, found: String) -> Alignment {
        let a = Piece::Run(offset.min(0).unsigned_abs(), None);
        let b = Piece::Run(offset.max(0).unsigned_abs(), None);
        let pieces = [vec![a], vec![b]];
        Alignment { pieces, found, offset: Some(offset), differences: Vec::new() }
    }
}

/// Time by which the second of two waveforms is late [fs], and how it was found.
///
/// # Errors
/// When the alignment is one of samples, or there is no edge.
pub(super) fn shift(plan: &Plan, align: &Align) -> Result<(i128, String)> {
    match align {
        Align::Start => Ok((0, "by time".to_owned())),
        Align::Shift { by, early } => {
            let fs = by.fs() as i128;
            let late = if *early { -fs } else { fs };
            Ok((late, format!("the second side {} ns late", late as f64 / 1e6)))
        }
        Align::Edge(signal) => edge::shift(plan, signal),
        _ => {
            let expected = "is about samples; say which clock they are taken by with --clock";
            Err(Input::new("--align", expected).into())
        }
    }
}

/// Finds the samples that belong together.
///
/// # Errors
/// When they cannot be found, or several ways are as good as each other.
pub(super) fn alignment(plan: &Plan, align: &Align, time_from: Option<&str>) -> Result<Alignment> {
    if time_from.is_some() && plan.capture().is_none() {
        let expected = "expected a capture on one side and a waveform on the other";
        return Err(Input::new("--time-from", expected).into());
    }
    let unsteady = time_from.is_some() || plan.qualifier.iter().any(Option::is_some);
    match align {
        Align::Trigger => trigger::alignment(plan, time_from),
        Align::Start | Align::Offset(_) if time_from.is_some() => {
            let offset = if let Align::Offset(samples) = align { *samples } else { 0 };
            trigger::counted(plan, time_from.unwrap_or_default(), offset)
        }
        _ if unsteady => {
            let expected = "expected trigger or, with --time-from, start or offset N: the samples \
                are not all of the clock's";
            Err(Input::new("--align", expected).into())
        }
        Align::Start => edge::start(plan),
        Align::Edge(signal) => edge::alignment(plan, signal),
        Align::Correlation(signals) => correlation::alignment(plan, signals),
        Align::Windows(signals) => windows::alignment(plan, signals),
        Align::Offset(samples) => Ok(Alignment::shifted(*samples, format!("offset {samples}"))),
        Align::Shift { .. } => {
            let expected = "expected samples, as `offset 3`, where samples are compared";
            Err(Input::new("--align", expected).into())
        }
    }
}
