//! Wide values as 64-bit words, least significant first; and lists of names.

use vcd::Value;

/// A value, and a mask of its unknown bits.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Bits {
    pub(crate) value: Vec<u64>,
    pub(crate) unknown: Vec<u64>,
}

impl Bits {
    /// Creates a value of 0 with the given width [bits].
    pub(crate) fn zero(width: u32) -> Bits {
        let mut bits = Bits::default();
        bits.clear(width.div_ceil(64) as usize);
        bits
    }

    /// Sets the value to 0 with the given number of words.
    #[inline]
    pub(crate) fn clear(&mut self, words: usize) {
        for place in [&mut self.value, &mut self.unknown] {
            place.clear();
            place.resize(words, 0);
        }
    }

    /// Returns whether all bits are known.
    pub(crate) fn is_known(&self) -> bool {
        self.unknown.iter().all(|&word| word == 0)
    }

    /// Returns the value, if it has at most 128 bits and all are known.
    pub(crate) fn number(&self) -> Option<u128> {
        (self.value.len() <= 2 && self.is_known()).then(|| lowest(&self.value))
    }

    /// Returns a bit as a VCD value.
    pub(crate) fn level(&self, at: u32) -> Value {
        match (bit(&self.unknown, at), bit(&self.value, at)) {
            (0, 0) => Value::V0,
            (0, _) => Value::V1,
            (_, 0) => Value::X,
            _ => Value::Z,
        }
    }
}

/// Returns the lowest 128 bits.
pub(crate) fn lowest(words: &[u64]) -> u128 {
    words.iter().take(2).rev().fold(0, |value, &word| value << 64 | u128::from(word))
}

/// Returns one bit.
#[inline]
pub(crate) fn bit(words: &[u64], bit: u32) -> u64 {
    words[bit as usize / 64] >> (bit % 64) & 1
}

/// Returns a mask of the bits that word `k` of a value of `width` bits uses.
pub(crate) fn ones(width: u32, k: usize) -> u64 {
    match (width as usize).saturating_sub(64 * k) {
        0 => 0,
        bits if bits >= 64 => u64::MAX,
        bits => (1 << bits) - 1,
    }
}

/// Sets the lowest `width` bits, and clears the others.
pub(crate) fn fill(words: &mut [u64], width: u32) {
    words.iter_mut().enumerate().for_each(|(k, word)| *word = ones(width, k));
}

/// Clears the bits above the width.
#[inline]
pub(crate) fn trim(words: &mut [u64], width: u32) {
    words.iter_mut().enumerate().for_each(|(k, word)| *word &= ones(width, k));
}

/// Lists at most `most` names, followed by `more` if there are others.
pub(crate) fn listed(names: &[String], most: usize, more: &str) -> String {
    let shown = names[..names.len().min(most)].join(", ");
    if names.len() > most { shown + more } else { shown }
}

/// Sign-extends a two's complement number of `width` bits.
pub(crate) fn extend(value: u128, width: u32) -> i128 {
    let shift = 128 - width.clamp(1, 128);
    ((value << shift) as i128) >> shift
}
