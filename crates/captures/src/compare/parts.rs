//! Signals and slices of a source that a comparison reads.

use crate::source::{Signal, SourceState};
use crate::words::{Bits, bit};

/// The distinct signals of a source that a comparison reads.
#[derive(Clone, Debug, Default)]
pub(super) struct Slots {
    /// Id of each signal.
    pub(super) ids: Vec<usize>,
    /// Index of each signal by its id.
    places: Vec<Option<usize>>,
}

impl Slots {
    /// Returns the index of a signal, which is added if necessary.
    pub(super) fn place(&mut self, id: usize) -> usize {
        if self.places.len() <= id {
            self.places.resize(id + 1, None);
        }
        *self.places[id].get_or_insert_with(|| {
            self.ids.push(id);
            self.ids.len() - 1
        })
    }
}

/// Orders what belongs to a side and to the other by side.
pub(super) fn ordered<T>(side: usize, own: T, other: T) -> [T; 2] {
    if side == 0 { [own, other] } else { [other, own] }
}

/// A slice of a cursor's signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part {
    /// Index of the signal in the cursor.
    pub(super) signal: usize,
    /// Lowest bit.
    pub(super) low: u32,
    /// Number of bits.
    pub(super) width: u32,
    /// Whether the slice is the whole signal.
    pub(super) whole: bool,
}

impl Part {
    /// Creates a slice of all bits of a signal, which is added to `slots` if necessary.
    pub(super) fn whole(slots: &mut Slots, signal: &Signal) -> Self {
        Part { signal: slots.place(signal.id), low: 0, width: signal.width, whole: true }
    }

    /// Copies the slice of `from` to `words`, from bit `low` on.
    fn put(&self, words: &mut [u64], low: u32, from: &[u64]) {
        for k in 0..self.width {
            let target = low + k;
            words[target as usize / 64] |= bit(from, self.low + k) << (target % 64);
        }
    }
}

/// Concatenates the values of several slices, highest first.
pub(super) fn gather(parts: &[Part], state: &SourceState, bits: &mut Bits) {
    if let [Part { whole: true, signal, .. }] = *parts {
        bits.clear(0);
        bits.value.extend_from_slice(state.value(signal));
        bits.unknown.extend_from_slice(state.unknown(signal));
        return;
    }
    let mut low = parts.iter().map(|part| part.width).sum::<u32>();
    bits.clear(low.div_ceil(64) as usize);
    for part in parts {
        low -= part.width;
        part.put(&mut bits.value, low, state.value(part.signal));
        part.put(&mut bits.unknown, low, state.unknown(part.signal));
    }
}
