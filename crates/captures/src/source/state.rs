//! Values of signals at one place.

use crate::words::ones;

/// Values of all signals of a cursor at one place; each begins at a word boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceState {
    first: Vec<u32>,
    value: Vec<u64>,
    unknown: Vec<u64>,
}

impl SourceState {
    /// Creates a state in which all bits are unknown.
    pub fn new(widths: &[u32]) -> Self {
        let mut first = vec![0];
        let mut unknown = Vec::new();
        for &width in widths {
            unknown.extend((0..width.div_ceil(64)).map(|k| ones(width, k as usize)));
            first.push(unknown.len() as u32);
        }
        SourceState { first, value: vec![0; unknown.len()], unknown }
    }

    /// Returns the range of a signal's words.
    pub(super) fn range(&self, signal: usize) -> std::ops::Range<usize> {
        self.first[signal] as usize..self.first[signal + 1] as usize
    }

    /// Returns the value of a signal, least significant word first; unknown bits are 0, or 1 for high impedance.
    #[inline]
    pub fn value(&self, signal: usize) -> &[u64] {
        &self.value[self.range(signal)]
    }

    /// Returns the mask of a signal's unknown bits.
    #[inline]
    pub fn unknown(&self, signal: usize) -> &[u64] {
        &self.unknown[self.range(signal)]
    }

    /// Sets the value and the unknown bits of a signal.
    #[inline]
    pub(super) fn set(&mut self, signal: usize, value: &[u64], unknown: &[u64]) {
        let range = self.range(signal);
        self.value[range.clone()].copy_from_slice(value);
        self.unknown[range].copy_from_slice(unknown);
    }

    /// Copies the value of a signal from another state of the same signals.
    #[inline]
    pub fn take(&mut self, from: &SourceState, signal: usize) {
        self.set(signal, from.value(signal), from.unknown(signal));
    }
}
