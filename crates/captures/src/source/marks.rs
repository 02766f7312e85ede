//! Marks of samples in a logic analyser's VCD.
//!
//! In Vivado's files, `_TRIGGER` and `_WINDOW` toggle at a trigger and at the start of a window, from 0 before the
//! first sample. In chipscopy's files, `_TRIGGER` is high for one sample, and `_WINDOW` starts at 0.

use wellen::SignalRef;

use super::names::Name;
use super::signals::Signal;
use super::stream::Feed;

/// Names of the marks.
const NAMES: [&str; 3] = ["_trigger", "_window", "_gap"];

/// Signals of the marks, and their dialect.
#[derive(Clone, Debug)]
pub(super) struct Style {
    /// Ids of `_TRIGGER`, `_WINDOW` and `_GAP`.
    ids: [Option<usize>; 3],
    /// Whether `_TRIGGER` is high only for the sample that triggered.
    pulses: bool,
}

impl Style {
    /// Detects the dialect of a VCD with the given signals; `None` if it is not from a logic analyser.
    pub(super) fn of(signals: &[Signal], version: &str) -> Option<Style> {
        let flat = signals.iter().all(|signal| signal.name.text.starts_with("dut."));
        let ids = NAMES.map(|name| {
            let mark = signals.iter().find(|signal| signal.name.last() == name);
            mark.filter(|mark| mark.width == 1 && mark.name.depth() == 2).map(|mark| mark.id)
        });
        let pulses = version.to_lowercase().contains("chipscop");
        (flat && ids[0].is_some() && ids[1].is_some()).then_some(Style { ids, pulses })
    }

    /// Removes the marks, and the scope common to all probes, from the list of signals.
    pub(super) fn hide(&self, signals: &mut Vec<Signal>) {
        signals.retain(|signal| !self.ids.contains(&Some(signal.id)));
        for signal in signals {
            let probe = signal.name.text.strip_prefix("dut.").unwrap_or(&signal.name.text);
            let Some(escaped) = probe.strip_prefix('\\') else {
                signal.name = Name::new(probe);
                continue;
            };
            // A name is escaped for its brackets; the library takes those of `P[1]` for a range.
            let whole = if signal.width == 1 && !escaped.contains('[') {
                format!("{escaped}[{}]", std::mem::take(&mut signal.lsb))
            } else {
                escaped.to_owned()
            };
            signal.name = Name::new(whole);
        }
    }
}

/// Decoder of the marks.
pub(super) struct Marking {
    references: [Option<SignalRef>; 3],
    pulses: bool,
    level: [bool; 3],
}

impl Marking {
    /// Creates a decoder; `references` are the library's signals by id.
    pub(super) fn new(style: &Style, references: &[SignalRef]) -> Self {
        let references = style.ids.map(|id| id.map(|id| references[id]));
        Marking { references, pulses: style.pulses, level: [false; 3] }
    }

    /// Returns the library's signals of the marks.
    pub(super) fn references(&self) -> impl Iterator<Item = SignalRef> {
        self.references.into_iter().flatten()
    }

    /// Processes a change of a signal, and marks the sample if the signal is a mark.
    #[inline]
    pub(super) fn change(&mut self, reference: SignalRef, at: u64, level: bool, feed: &mut Feed) {
        let Some(mark) = self.references.iter().position(|&mark| mark == Some(reference)) else {
            return;
        };
        let changed = self.level[mark] != level;
        self.level[mark] = level;
        if mark == 1 && at == 0 {
            self.pulses |= !level;
            feed.mark(|marks| marks.window = true);
            return;
        }
        match mark {
            0 if level || (changed && !self.pulses) => {
                feed.mark(|marks| marks.trigger |= changed);
            }
            1 => feed.mark(|marks| marks.window |= changed),
            _ => {}
        }
    }
}
