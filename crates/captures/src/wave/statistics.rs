//! What the signals of a waveform do: changes, pulses and frequencies.

use tofsim::error::Result;

use crate::source::{Signal, SignalKind, Source};
use crate::words::bit;

use super::excerpt::Excerpt;
use super::pulses::{Edges, Pulses};

/// Activity of a signal.
#[derive(Clone, Debug)]
pub struct SignalStatistics<'a> {
    /// The signal, by its first name.
    pub signal: &'a Signal,
    /// Number of instants at which the value changes, or an event occurs.
    pub changes: u64,
    /// Number of changes of single bits between 0 and 1.
    pub toggles: u64,
    /// First and last change, in units of the source.
    pub first: Option<u64>,
    /// Last change.
    pub last: Option<u64>,
    /// Pulses of a single bit: low ones, and high ones.
    pub pulses: Option<[Pulses; 2]>,
    /// Mean time from one rising edge of a single bit to the next, in units of the source.
    pub period: Option<f64>,
}

/// Value and activity of a signal so far.
#[derive(Default)]
struct Activity {
    value: Vec<u64>,
    unknown: Vec<u64>,
    is_known: bool,
    changes: u64,
    toggles: u64,
    first: Option<u64>,
    last: Option<u64>,
    edges: Option<Edges>,
}

/// Reads an excerpt of a source; returns the activity of each of its signals, and its end in units of the source. A
/// signal's first value is no change.
///
/// # Errors
/// If the source cannot be read, or has no such signals.
pub fn statistics<'a>(
    source: &'a Source,
    excerpt: &Excerpt,
) -> Result<(Vec<SignalStatistics<'a>>, u64)> {
    let chosen = excerpt.of(source)?;
    let firsts = chosen.firsts();
    let begin = |signal: &&Signal| {
        let is_bit = signal.kind == SignalKind::Bits && signal.width == 1;
        Activity { edges: is_bit.then(Edges::default), ..Activity::default() }
    };
    let mut all: Vec<Activity> = firsts.iter().map(begin).collect();
    let end = chosen.read(|instant| {
        for &place in instant.changed {
            let (value, unknown) = (instant.state.value(place), instant.state.unknown(place));
            match firsts[place].kind {
                SignalKind::Event => all[place].count(instant.at),
                _ => all[place].change(instant.at, value, unknown),
            }
        }
        Ok(())
    })?;
    let found = firsts.iter().zip(all).map(|(&signal, activity)| SignalStatistics {
        signal,
        changes: activity.changes,
        toggles: if signal.kind == SignalKind::Bits { activity.toggles } else { 0 },
        first: activity.first,
        last: activity.last,
        pulses: activity.edges.map(|edges| edges.pulses),
        period: activity.edges.and_then(|edges| edges.period()),
    });
    Ok((found.collect(), end))
}

impl Activity {
    fn count(&mut self, at: u64) {
        self.changes += 1;
        self.first.get_or_insert(at);
        self.last = Some(at);
    }

    fn change(&mut self, at: u64, value: &[u64], unknown: &[u64]) {
        if self.is_known {
            if self.value == value && self.unknown == unknown {
                return;
            }
            self.count(at);
            let words = value.iter().zip(unknown).zip(self.value.iter().zip(&self.unknown));
            self.toggles += words
                .map(|((new, x), (old, was_x))| {
                    u64::from(((new ^ old) & !(x | was_x)).count_ones())
                })
                .sum::<u64>();
        }
        if let Some(edges) = &mut self.edges {
            edges.change(at, (bit(unknown, 0) == 0).then(|| bit(value, 0) == 1));
        }
        self.is_known = true;
        self.value.clear();
        self.value.extend_from_slice(value);
        self.unknown.clear();
        self.unknown.extend_from_slice(unknown);
    }
}
