//! The changes of one signal in a section of an FST file.
//!
//! A change is how many times of the section have passed since the one before, and the value: in
//! the same number for a single bit, and behind it otherwise.

use super::blocks::number;

/// Shortest stream that is compressed [bytes].
const SHORT: usize = 32;

/// One signal.
pub(super) struct Stream {
    /// [bits].
    pub(super) width: usize,
    pub(super) data: Vec<u8>,
    /// Number of the time of the last change, from 0 in each section.
    time: u64,
    /// The value, its highest bit the highest of the first byte; `None` is unknown.
    pub(super) value: Option<Box<[u8]>>,
}

impl Stream {
    /// A signal of so many bits, unknown.
    pub(super) fn new(width: usize) -> Self {
        Stream { width, data: Vec::new(), time: 0, value: None }
    }

    /// The signal has that value from now on.
    #[inline]
    pub(super) fn set(&mut self, value: &[u8]) {
        match &mut self.value {
            Some(kept) => kept.copy_from_slice(value),
            kept => *kept = Some(value.into()),
        }
    }

    /// Notes that it has changed to `value` at the time of that number; how many bytes that took.
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

    /// Notes that it has become unknown at the time of that number.
    pub(super) fn note_unknown(&mut self, time: u64) {
        let delta = self.since(time);
        if self.width == 1 {
            number(&mut self.data, delta << 4 | 1);
        } else {
            number(&mut self.data, delta << 1 | 1);
            self.data.resize(self.data.len() + self.width, b'x');
        }
    }

    /// Times since the last change.
    #[inline]
    fn since(&mut self, time: u64) -> u64 {
        time - std::mem::replace(&mut self.time, time)
    }

    /// Appends the value, a digit for each bit.
    pub(super) fn spell(&self, text: &mut Vec<u8>) {
        match &self.value {
            None => text.resize(text.len() + self.width, b'x'),
            Some(value) => text.extend(
                (0..self.width).map(|place| b'0' + (value[place / 8] >> (7 - place % 8) & 1)),
            ),
        }
    }

    /// Appends what was noted, with LZ4 if that is shorter, and begins anew; how many bytes it was.
    pub(super) fn take(&mut self, section: &mut Vec<u8>) -> usize {
        let Stream { data, time, .. } = self;
        let length = data.len();
        let packed = (length >= SHORT).then(|| lz4_flex::block::compress(data));
        match packed.filter(|packed| packed.len() < length) {
            Some(packed) => {
                number(section, length as u64);
                section.extend_from_slice(&packed);
            }
            None => {
                let as_it_is = 0;
                number(section, as_it_is);
                section.extend_from_slice(data);
            }
        }
        data.clear();
        *time = 0;
        length
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
