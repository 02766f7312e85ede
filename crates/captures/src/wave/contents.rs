//! Contents of a waveform, without its values.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use crate::source::{Signal, SignalKind, Source};

/// Counts of what a waveform has.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Contents {
    /// Number of scopes.
    pub scopes: usize,
    /// Number of names of signals.
    pub names: usize,
    /// Number of different signals.
    pub signals: usize,
    /// Number of bits of these.
    pub bits: u64,
    /// Number of different signals of each type.
    pub types: BTreeMap<&'static str, usize>,
}

impl Contents {
    /// Counts the contents of a source.
    pub fn of(source: &Source) -> Contents {
        let mut scopes = BTreeSet::new();
        let mut ids = HashSet::new();
        let mut contents = Contents { names: source.signals.len(), ..Contents::default() };
        for signal in &source.signals {
            let all = (1..=signal.scopes.len()).rev().map(|depth| &signal.scopes[..depth]);
            // What is outside of a known scope is known.
            all.take_while(|scope| scopes.insert(*scope)).for_each(drop);
            if !ids.insert(signal.id) {
                continue;
            }
            contents.signals += 1;
            *contents.types.entry(Contents::type_of(signal)).or_default() += 1;
            if signal.kind == SignalKind::Bits {
                contents.bits += u64::from(signal.width);
            }
        }
        contents.scopes = scopes.len();
        contents
    }

    /// Returns the name of a signal's type: `bit`, `vector`, `enumeration`, `real`, `text` or `event`.
    pub fn type_of(signal: &Signal) -> &'static str {
        match signal.kind {
            SignalKind::Real => "real",
            SignalKind::Text => "text",
            SignalKind::Event | SignalKind::Other => "event",
            SignalKind::Bits if !signal.words.states.is_empty() => "enumeration",
            SignalKind::Bits if signal.width == 1 => "bit",
            SignalKind::Bits => "vector",
        }
    }

    /// Returns the width of a signal's values [bits], if they are bits.
    pub fn width(signal: &Signal) -> Option<u32> {
        (signal.kind == SignalKind::Bits).then_some(signal.width)
    }
}
