//! Alignment of the samples of two sides.

mod alignment;
mod correlation;
mod edge;
mod survey;
mod trigger;
mod windows;

use tofsim::error::{Input, Result};

use super::plan::Plan;

pub use alignment::Align;
pub(super) use alignment::Alignment;
pub(super) use correlation::SearchEnd;
pub(super) use survey::windows_differ;
pub use survey::{Survey, survey};

/// Determines the time shift between two waveforms: the delay of the second [fs], and a description of how it was
/// found.
///
/// # Errors
/// If the alignment is in samples, or there is no edge.
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

/// Determines the matching samples.
///
/// # Errors
/// If there is no match, or several are equally good.
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
            trigger::by_counter(plan, time_from.unwrap_or_default(), 0, offset)
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
