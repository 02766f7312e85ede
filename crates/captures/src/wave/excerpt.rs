//! A part of a waveform: some signals, and a range of time.

use std::collections::HashMap;

use tofsim::error::{Input, Result};
use tofsim::kernel::Time;

use crate::choice::SignalChoice;
use crate::source::{Axis, Signal, SignalKind, Source, SourceState};

/// Which part of a waveform is read.
#[derive(Clone, Debug, Default)]
pub struct Excerpt {
    /// Signals to read.
    pub choice: SignalChoice,
    /// Start, from which on changes are read.
    pub after: Option<Time>,
    /// End, before which changes are read.
    pub until: Option<Time>,
}

/// Signals of an excerpt.
pub(super) struct Chosen<'a> {
    source: &'a Source,
    /// All chosen names, with the place of their signal in `ids`.
    pub(super) names: Vec<(&'a Signal, usize)>,
    ids: Vec<usize>,
    /// Start and end, in units of the source.
    from: u64,
    until: u64,
}

/// An instant of an excerpt.
pub(super) struct Instant<'a> {
    /// Time or sample number, in units of the source.
    pub(super) at: u64,
    /// Values.
    pub(super) state: &'a SourceState,
    /// Signals with a change or an event, in ascending order; at the start of an excerpt, also all that have a value.
    pub(super) changed: &'a [usize],
}

impl Excerpt {
    /// Finds the signals of the excerpt in a source.
    ///
    /// # Errors
    /// If a pattern is invalid, no signal is chosen, or a time is given for a capture.
    pub(super) fn of<'a>(&self, source: &'a Source) -> Result<Chosen<'a>> {
        let range = |time: Option<Time>, option: &str, default: u64| match (time, source.axis) {
            (None, _) => Ok(default),
            (Some(time), Axis::Time(tick)) => Ok(tick.count_up(time.fs() as u128)),
            (Some(_), Axis::Samples) => {
                Err(Input::new(option, "expected a waveform: a capture has no times"))
            }
        };
        let from = range(self.after, "--after", 0)?;
        let until = range(self.until, "--until", u64::MAX)?;
        if until <= from {
            return Err(Input::new("--until", "expected a time after that of --after").into());
        }
        if let Some(end) = source.end.filter(|&end| self.after.is_some() && end < from) {
            let end = source.axis.place_text(end);
            let expected = format!("expected a time in {}, which ends at {end}", source.name);
            return Err(Input::new("--after", expected).into());
        }
        let patterns = self.choice.patterns(&[])?;
        let (mut names, mut ids, mut places) = (Vec::new(), Vec::new(), HashMap::new());
        for signal in &source.signals {
            if patterns.has(&[&signal.name.text], None) {
                let place = *places.entry(signal.id).or_insert_with(|| {
                    ids.push(signal.id);
                    ids.len() - 1
                });
                names.push((signal, place));
            }
        }
        if names.is_empty() {
            let expected = match source.signals.len() {
                0 => "has no signals".to_owned(),
                1 => "its signal is not chosen (--signals, --ignore)".to_owned(),
                count => format!("none of its {count} signals is chosen (--signals, --ignore)"),
            };
            return Err(Input::new(&source.name, expected).into());
        }
        Ok(Chosen { source, names, ids, from, until })
    }
}

impl<'a> Chosen<'a> {
    /// Returns the number of different signals.
    pub(super) fn len(&self) -> usize {
        self.ids.len()
    }

    /// Returns the first name of each different signal.
    pub(super) fn firsts(&self) -> Vec<&'a Signal> {
        let mut firsts = vec![None; self.ids.len()];
        for (signal, place) in &self.names {
            firsts[*place].get_or_insert(*signal);
        }
        firsts.into_iter().flatten().collect()
    }

    /// Calls `each` with every instant of the excerpt, and returns its end.
    ///
    /// # Errors
    /// If the source cannot be read, or `each` fails.
    pub(super) fn read(&self, mut each: impl FnMut(&Instant) -> Result<()>) -> Result<u64> {
        let mut cursor = self.source.read(&self.ids)?;
        let mut changed: Vec<usize> = Vec::new();
        let mut known = vec![false; self.ids.len()];
        let firsts = self.firsts();
        let has_value = |signal: usize| firsts[signal].kind != SignalKind::Event;
        let mut last = 0;
        while let Some(at) = cursor.peek()?.filter(|&at| at < self.from) {
            cursor.take(|signal| known[signal] = has_value(signal));
            last = at;
        }
        if self.from > 0 {
            if cursor.peek()? == Some(self.from) {
                cursor.take(|signal| known[signal] = true);
            }
            changed.extend((0..known.len()).filter(|&signal| known[signal]));
            let (state, changed) = (&cursor.state, &changed[..]);
            each(&Instant { at: self.from, state, changed })?;
            last = self.from;
        }
        while let Some(at) = cursor.peek()?.filter(|&at| at < self.until) {
            changed.clear();
            cursor.take(|signal| changed.push(signal));
            changed.sort_unstable();
            changed.dedup();
            each(&Instant { at, state: &cursor.state, changed: &changed })?;
            last = at;
        }
        Ok(self.source.end.unwrap_or(0).max(last).min(self.until))
    }
}
