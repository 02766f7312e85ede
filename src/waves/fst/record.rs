//! The changes of a signal of any type in a section of an FST file.

use super::super::dump::signal::{DumpKind, DumpValue};
use super::blocks::number;
use super::signal_stream::SignalStream;

/// Stream of one signal.
pub(super) struct Record {
    kind: DumpKind,
    data: Vec<u8>,
    /// Number of the time step of the last change, from 0 in each section.
    time: u64,
    /// Value and mask of unknown bits, least significant word first; of a real number, the first word.
    value: Vec<u64>,
    unknown: Vec<u64>,
}

impl Record {
    /// Creates the stream of an unknown signal.
    pub(super) fn new(kind: DumpKind) -> Record {
        let words = match kind {
            DumpKind::Bits(width) => width.div_ceil(64) as usize,
            DumpKind::Real | DumpKind::Event => 1,
            DumpKind::Text => 0,
        };
        let unknown_value = if kind == DumpKind::Real { f64::NAN.to_bits() } else { 0 };
        let (value, unknown) = (vec![unknown_value; words], vec![u64::MAX; words]);
        Record { kind, data: Vec::new(), time: 0, value, unknown }
    }

    /// Appends a change at a time step, and returns its size in bytes.
    pub(super) fn note(&mut self, time: u64, value: DumpValue<'_>) -> usize {
        let before = self.data.len();
        let delta = time - std::mem::replace(&mut self.time, time);
        match value {
            DumpValue::Bits { value, unknown } => {
                self.value.copy_from_slice(value);
                self.unknown.copy_from_slice(unknown);
                self.bits(delta);
            }
            DumpValue::Real(real) => {
                (self.value[0], self.unknown[0]) = (real.to_bits(), 0);
                number(&mut self.data, delta << 1 | 1);
                self.data.extend_from_slice(&real.to_le_bytes());
            }
            DumpValue::Text(text) => {
                number(&mut self.data, delta << 1);
                number(&mut self.data, text.len() as u64);
                self.data.extend_from_slice(text.as_bytes());
            }
            DumpValue::Event => number(&mut self.data, delta << 2 | 2),
        }
        self.data.len() - before
    }

    /// Appends the present levels: as bits if all are known, and otherwise as digits.
    fn bits(&mut self, delta: u64) {
        let DumpKind::Bits(width) = self.kind else { return };
        let is_known = self.unknown.iter().all(|&word| word == 0);
        match (width, is_known) {
            (1, true) => number(&mut self.data, delta << 2 | (self.value[0] & 1) << 1),
            (1, false) => number(&mut self.data, delta << 4 | (self.value[0] & 1) << 1 | 1),
            (_, true) => {
                number(&mut self.data, delta << 1);
                let (bytes, shift) = (width.div_ceil(8) as usize, (8 - width % 8) % 8);
                for place in (0..bytes).rev() {
                    let byte = |at: usize| (self.value[at / 8] >> (8 * (at % 8))) as u8;
                    let below = if place > 0 { byte(place - 1) } else { 0 };
                    let both = u16::from(byte(place)) << 8 | u16::from(below);
                    self.data.push((both << shift >> 8) as u8);
                }
            }
            (_, false) => {
                number(&mut self.data, delta << 1 | 1);
                let (value, unknown) = (&self.value, &self.unknown);
                let digits = (0..width).rev().map(|bit| DumpValue::digit(value, unknown, bit));
                self.data.extend(digits);
            }
        }
    }
}

impl SignalStream for Record {
    fn spell(&self, frame: &mut Vec<u8>) {
        match self.kind {
            DumpKind::Bits(width) => {
                let digit = |bit| DumpValue::digit(&self.value, &self.unknown, bit);
                frame.extend((0..width).rev().map(digit));
            }
            DumpKind::Real => frame.extend_from_slice(&self.value[0].to_le_bytes()),
            DumpKind::Text => {}
            DumpKind::Event => frame.push(b'x'),
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
    fn known_levels_are_packed_and_others_are_digits() {
        let mut record = Record::new(DumpKind::Bits(9));
        let mut frame = Vec::new();
        record.spell(&mut frame);
        assert_eq!(frame, b"xxxxxxxxx");
        record.note(3, DumpValue::Bits { value: &[0b1_0100_0001], unknown: &[0] });
        assert_eq!(record.data, [6, 0b1010_0000, 0b1000_0000]);
        record.note(4, DumpValue::Bits { value: &[0b11], unknown: &[0b10] });
        assert_eq!(&record.data[3..], b"\x030000000z1");
        let mut bit = Record::new(DumpKind::Bits(1));
        bit.note(1, DumpValue::Bits { value: &[1], unknown: &[0] });
        bit.note(2, DumpValue::Bits { value: &[1], unknown: &[1] });
        assert_eq!(bit.data, [0b110, 0b1_0011]);
    }

    #[test]
    fn a_text_has_its_length() {
        let mut record = Record::new(DumpKind::Text);
        record.note(2, DumpValue::Text("aµ"));
        assert_eq!(record.data, [4, 3, b'a', 0xc2, 0xb5]);
    }
}
