//! Windows and triggers of a capture.

use tofsim::error::Result;

use crate::source::{Source, SourceFormat};

/// A window of a capture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Number of its first sample.
    pub first: u64,
    /// Number of samples, if it is known.
    pub count: Option<u64>,
    /// Number, in the buffer, of the sample that triggered.
    pub trigger: Option<u64>,
}

/// Structure of a capture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Survey {
    /// Windows.
    pub windows: Vec<Window>,
    /// Number of samples, if it is known.
    pub samples: Option<u64>,
    /// Number of gaps.
    pub gaps: u64,
    /// Last sample that the capture mentions.
    pub last: Option<u64>,
}

/// Reads a capture once to find its structure.
///
/// # Errors
/// If it cannot be read.
pub fn survey(source: &Source) -> Result<Survey> {
    let mut survey = Survey::default();
    // Of a VCD, only the changes of all signals describe how far it goes.
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

/// Describes different numbers of windows, if they differ.
pub(crate) fn windows_differ(a: usize, b: usize) -> Option<String> {
    (a != b).then(|| format!("the first has {a} windows, the second {b}"))
}

/// Describes different trigger positions in window `k`, if they differ.
pub(super) fn triggers_differ(k: usize, a: &Window, b: &Window) -> Option<String> {
    let [a, b] = [a, b].map(|window| window.trigger.map(|at| at - window.first));
    let describe = |at: Option<u64>| at.map_or("none".to_owned(), |at| at.to_string());
    let places =
        || format!("at sample {} of the first, {} of the second", describe(a), describe(b));
    (a != b).then(|| format!("window {k}: trigger {}", places()))
}

/// Describes different numbers of samples in window `k`, if they differ.
pub(super) fn counts_differ(k: usize, a: &Window, b: &Window) -> Option<String> {
    let (a, b) = (a.count?, b.count?);
    (a != b).then(|| format!("window {k}: {a} samples in the first, {b} in the second"))
}
