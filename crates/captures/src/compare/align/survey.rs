//! What a capture says of its windows and triggers.

use tofsim::error::Result;

use crate::source::{Source, SourceFormat};

/// A window of a capture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Number of its first sample.
    pub first: u64,
    /// Number of its samples, if that is known.
    pub count: Option<u64>,
    /// Number of the sample that triggered, in the buffer.
    pub trigger: Option<u64>,
}

/// What a pass over a capture finds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Survey {
    /// Windows.
    pub windows: Vec<Window>,
    /// Number of samples, if that is known.
    pub samples: Option<u64>,
    /// Samples at which others are missing.
    pub gaps: u64,
    /// Last sample that something is said of.
    pub last: Option<u64>,
}

/// Passes over a capture once.
///
/// # Errors
/// When it cannot be read.
pub fn survey(source: &Source) -> Result<Survey> {
    let mut survey = Survey::default();
    // Of a VCD, only the changes of all signals tell how far it goes.
    let is_vcd = source.format == SourceFormat::IlaVcd;
    let count = if is_vcd { usize::MAX } else { 1 };
    let ids: Vec<usize> = source.signals.iter().take(count).map(|signal| signal.id).collect();
    let mut cursor = source.read(&ids)?;
    while let Some(at) = cursor.peek()? {
        let marks = cursor.take(|_| ());
        survey.last = Some(at);
        survey.gaps += u64::from(marks.gap);
        if marks.window || survey.windows.is_empty() {
            survey.windows.push(Window { first: at, count: None, trigger: None });
        }
        if marks.trigger
            && let Some(window) = survey.windows.last_mut()
        {
            window.trigger = Some(at);
        }
    }
    survey.samples = (!is_vcd).then(|| survey.last.map_or(0, |last| last + 1));
    let mut end = survey.samples;
    for window in survey.windows.iter_mut().rev() {
        window.count = end.map(|end| end - window.first);
        end = Some(window.first);
    }
    Ok(survey)
}

/// That the sides have not as many windows.
pub(super) fn windows_differ(a: &[Window], b: &[Window]) -> Option<String> {
    let (a, b) = (a.len(), b.len());
    (a != b).then(|| format!("the first has {a} windows, the second {b}"))
}

/// That the windows of number `k` of both sides have not their triggers at the same place.
pub(super) fn triggers_differ(k: usize, a: &Window, b: &Window) -> Option<String> {
    let [a, b] = [a, b].map(|window| window.trigger.map(|at| at - window.first));
    let tell = |at: Option<u64>| at.map_or("none".to_owned(), |at| at.to_string());
    let places = || format!("at sample {} of the first, {} of the second", tell(a), tell(b));
    (a != b).then(|| format!("window {k}: trigger {}", places()))
}

/// That the windows of number `k` of both sides have not as many samples.
pub(super) fn counts_differ(k: usize, a: &Window, b: &Window) -> Option<String> {
    let (a, b) = (a.count?, b.count?);
    (a != b).then(|| format!("window {k}: {a} samples in the first, {b} in the second"))
}
