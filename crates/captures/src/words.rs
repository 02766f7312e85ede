//! Bits of wide values, in words of 64, the lowest first.

use vcd::Value;

/// A value: bits, and which of them are unknown.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Bits {
    pub(crate) value: Vec<u64>,
    pub(crate) unknown: Vec<u64>,
}

impl Bits {
    /// Makes it 0, of so many words.
    #[inline]
    pub(crate) fn clear(&mut self, words: usize) {
        for place in [&mut self.value, &mut self.unknown] {
            place.clear();
            place.resize(words, 0);
        }
    }

    /// Whether no bit is unknown.
    pub(crate) fn is_known(&self) -> bool {
        self.unknown.iter().all(|&word| word == 0)
    }

    /// The value, if it has at most 128 bits, all known.
    pub(crate) fn number(&self) -> Option<u128> {
        (self.value.len() <= 2 && self.is_known()).then(|| lowest(&self.value))
    }

    /// What a waveform has for a bit.
    pub(crate) fn level(&self, at: u32) -> Value {
        match (bit(&self.unknown, at), bit(&self.value, at)) {
            (0, 0) => Value::V0,
            (0, _) => Value::V1,
            (_, 0) => Value::X,
            _ => Value::Z,
        }
    }
}

/// The lowest 128 bits.
pub(crate) fn lowest(words: &[u64]) -> u128 {
    words.iter().take(2).rev().fold(0, |value, &word| value << 64 | u128::from(word))
}

/// A bit.
#[inline]
pub(crate) fn bit(words: &[u64], bit: u32) -> u64 {
    words[bit as usize / 64] >> (bit % 64) & 1
}

/// The bits that word `k` of a value of `width` bits has.
pub(crate) fn ones(width: u32, k: usize) -> u64 {
    match (width as usize).saturating_sub(64 * k) {
        0 => 0,
        bits if bits >= 64 => u64::MAX,
        bits => (1 << bits) - 1,
    }
}

/// Clears what is above the width in the words of a value.
#[inline]
pub(crate) fn trim(words: &mut [u64], width: u32) {
    words.iter_mut().enumerate().for_each(|(k, word)| *word &= ones(width, k));
}

/// A two's complement number of `width` bits.
pub(crate) fn extend(value: u128, width: u32) -> i128 {
    let shift = 128 - width.clamp(1, 128);
    ((value << shift) as i128) >> shift
}
