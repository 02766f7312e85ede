//! The value of a signal, bit by bit.

use vcd::Value;

use crate::words::bit;

/// A value in words: bits, and which of them are unknown.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Bits {
    pub(super) value: Vec<u64>,
    pub(super) unknown: Vec<u64>,
}

impl Bits {
    /// Whether no bit is unknown.
    pub(super) fn is_known(&self) -> bool {
        self.unknown.iter().all(|&word| word == 0)
    }

    /// The value, if it has at most 128 bits, all known.
    pub(super) fn number(&self) -> Option<u128> {
        let low = self.value.first().copied().unwrap_or(0);
        let high = self.value.get(1).copied().unwrap_or(0);
        (self.value.len() <= 2 && self.is_known()).then_some(low as u128 | (high as u128) << 64)
    }

    /// What a waveform has for a bit.
    pub(super) fn level(&self, at: u32) -> Value {
        match (bit(&self.unknown, at), bit(&self.value, at)) {
            (0, 0) => Value::V0,
            (0, _) => Value::V1,
            (_, 0) => Value::X,
            _ => Value::Z,
        }
    }
}
