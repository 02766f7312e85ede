//! The changes of one signal in a section of an FST file.
//!
//! A change consists of the number of time steps since the previous one, and the value: in the same integer for a
//! single bit, and after it otherwise.

use super::blocks::number;
use super::signal_stream::SignalStream;

/// Stream of one signal.
pub(super) struct Stream {
    /// Width [bits].
    pub(super) width: usize,
    data: Vec<u8>,
    /// Number of the time step of the last change, from 0 in each section.
    time: u64,
    /// Value, most significant bit first; `None` if it is unknown.
    pub(super) value: Option<Box<[u8]>>,
}

impl Stream {
    /// Creates the stream of an unknown signal.
    pub(super) fn new(width: usize) -> Self {
        Stream { width, data: Vec::new(), time: 0, value: None }
    }

    /// Sets the value without a change in the stream.
    #[inline]
    pub(super) fn set(&mut self, value: &[u8]) {
        match &mut self.value {
            Some(kept) => kept.copy_from_slice(value),
            kept => *kept = Some(value.into()),
        }
    }

    /// Appends a change to `value` at a time step, and returns its size in bytes.
    #[inline]
    pub(super) fn note(&mut self, time: u64, value: &[u8]) -> usize {
        let (before, delta) = (self.data.len(), self.since(time));
        if self.width == 1 {
            number(&mut self.data, delta << 2 | u64::from(value[0] >> 7) << 1);
        } else {
            number(&mut self.data, delta << 1);
            self.data.extend_from_slice(value);
        }
        self.data.len() - before
    }

    /// Appends a change to unknown at a time step.
    pub(super) fn note_unknown(&mut self, time: u64) {
        let delta = self.since(time);
        if self.width == 1 {
            number(&mut self.data, delta << 4 | 1);
        } else {
            number(&mut self.data, delta << 1 | 1);
            self.data.resize(self.data.len() + self.width, b'x');
        }
    }

    /// Returns the number of time steps since the last change.
    #[inline]
    fn since(&mut self, time: u64) -> u64 {
        time - std::mem::replace(&mut self.time, time)
    }
}

impl SignalStream for Stream {
    /// Appends one digit per bit.
    fn spell(&self, text: &mut Vec<u8>) {
        match &self.value {
            None => text.resize(text.len() + self.width, b'x'),
            Some(value) => text.extend(
                (0..self.width).map(|place| b'0' + (value[place / 8] >> (7 - place % 8) & 1)),
            ),
        }
    }

    fn hand_over(&mut self, buffer: &mut Vec<u8>) {
        std::mem::swap(&mut self.data, buffer);
        self.time = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_spelled_from_its_highest_bit() {
        let mut stream = Stream::new(9);
        stream.set(&[0b1010_0000, 0b1000_0000]);
        let mut text = Vec::new();
        stream.spell(&mut text);
        assert_eq!(text, b"101000001");
        stream.value = None;
        stream.spell(&mut text);
        assert_eq!(text, b"101000001xxxxxxxxx");
    }
}
