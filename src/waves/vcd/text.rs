//! Text of a VCD file's body, written to a buffer with space for a complete step.

use std::io::{self, Write};

use crate::kernel::Thermometer;

use super::super::digits::{THREE_DIGITS, eight};

/// Amount of text that is collected before it is written [bytes].
const BLOCK: usize = 1 << 16;
/// Space for a step in addition to its values: the time, a keyword at each end, and the excess of fixed-size copies
/// [bytes].
const SPARE: usize = 128;
/// Unit of a time's leading digits: the last six digits are looked up in a table [ps].
const LEAD: u64 = 1_000_000;

/// Text that has not been written yet.
pub(super) struct Text {
    /// Buffer, with space for the longest step after [`BLOCK`] bytes.
    bytes: Box<[u8]>,
    pub(super) len: usize,
    /// Leading digits of the last time, after a `#`.
    lead: [u8; 16],
    lead_len: usize,
    /// Time of these digits followed by zeros; 0 before the first time [ps].
    lead_at: u64,
}

/// Text after a value, at most seven bytes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tail {
    /// Space for a digit, followed by the tail.
    line: u64,
    /// Length without the digit [bytes].
    len: u8,
    /// Length with it, or 0 if the tail is empty [bytes].
    line_len: u8,
}

impl Tail {
    /// Creates a tail; text beyond the seventh byte is dropped.
    pub(super) fn new(text: &str) -> Self {
        let mut line = [0; 8];
        line[1..].iter_mut().zip(text.bytes()).for_each(|(byte, text)| *byte = text);
        let len = text.len().min(7) as u8;
        let line_len = if len > 0 { len + 1 } else { 0 };
        Tail { line: u64::from_le_bytes(line), len, line_len }
    }

    /// Returns the length [bytes].
    pub(super) fn len(&self) -> usize {
        self.len as usize
    }
}

/// Copies `N` bytes, of which excess ones are overwritten later: copying a fixed number is faster.
#[inline(always)]
fn put<const N: usize>(bytes: &mut [u8], at: usize, text: &[u8; N]) {
    bytes[at..][..N].copy_from_slice(text);
}

// The place in the text is a local variable in each of these, because a field that is stored and
// loaded for every few bytes is what would limit the speed.
impl Text {
    /// Creates a buffer for steps whose values take up to `longest` bytes.
    pub(super) fn new(longest: usize) -> Self {
        let bytes = vec![0; BLOCK + longest + SPARE].into_boxed_slice();
        Text { bytes, len: 0, lead: [0; 16], lead_len: 0, lead_at: 0 }
    }

    /// Returns whether there is enough text for a write.
    #[inline]
    pub(super) fn is_full(&self) -> bool {
        self.len >= BLOCK
    }

    /// Writes the text to a file. After an error it is lost.
    pub(super) fn write(&mut self, file: &mut impl Write) -> io::Result<()> {
        let text = &self.bytes[..std::mem::take(&mut self.len)];
        file.write_all(text)
    }

    pub(super) fn push(&mut self, text: &[u8]) {
        self.bytes[self.len..][..text.len()].copy_from_slice(text);
        self.len += text.len();
    }

    /// Appends a time [ps].
    #[inline]
    pub(super) fn stamp(&mut self, at: u64) {
        let rest = at.wrapping_sub(self.lead_at);
        if rest >= LEAD || self.lead_at == 0 {
            return self.stamp_anew(at);
        }
        let [thousands, units] =
            [rest / 1000, rest % 1000].map(|number| THREE_DIGITS[number as usize]);
        let line = &mut self.bytes[self.len..][..32];
        let place = self.lead_len % 16;
        put(line, 0, &self.lead);
        put(line, place, &thousands);
        put(line, place + 3, &units);
        self.len += place + 7;
    }

    /// Appends a time whose leading digits differ from those of the last one [ps].
    #[cold]
    #[inline(never)]
    fn stamp_anew(&mut self, at: u64) {
        self.push(format!("#{at}\n").as_bytes());
        let lead = format!("#{}", at / LEAD);
        self.lead[..lead.len()].copy_from_slice(lead.as_bytes());
        (self.lead_at, self.lead_len) = (at - at % LEAD, lead.len());
    }

    /// Appends the value of a bit; nothing if its tail is empty.
    #[inline(always)]
    pub(super) fn bit(&mut self, value: u64, tail: Tail) {
        let line = tail.line | u64::from(b'0') | (value & 1);
        put(&mut self.bytes, self.len, &line.to_le_bytes());
        self.len += usize::from(tail.line_len);
    }

    /// Appends an unknown value.
    pub(super) fn unknown(&mut self, is_vector: bool, tail: Tail) {
        if is_vector {
            self.push(b"b");
        }
        let line = tail.line | u64::from(b'x');
        self.push(&line.to_le_bytes()[..1 + tail.len()]);
    }

    /// Appends a vector of up to 64 bits without leading zeros.
    #[inline(never)]
    pub(super) fn number(&mut self, value: u64, tail: Tail) {
        let (bytes, place) = (&mut self.bytes[..], self.len);
        let place = put_number(bytes, place, value);
        put(bytes, place, &(tail.line >> 8).to_le_bytes());
        self.len = place + tail.len();
    }

    /// Appends a vector of `count` taps in order of arrival, the last one first, without leading zeros.
    pub(super) fn taps(&mut self, taps: &Thermometer, count: usize, tail: Tail) {
        let width = taps.high_runs(count).last().map_or(1, |run| run.end);
        let (bytes, place) = (&mut self.bytes[..], self.len);
        put(bytes, place, b"b");
        let (place, end) = (place + 1, place + 1 + width);
        bytes[place..end].fill(b'0');
        for run in taps.high_runs(count) {
            bytes[end - run.end..end - run.start].fill(b'1');
        }
        put(bytes, end, &(tail.line >> 8).to_le_bytes());
        self.len = end + tail.len();
    }

    /// Appends a vector of `words`, least significant first, without leading zeros.
    pub(super) fn vector(&mut self, words: &[u64], tail: Tail) {
        let (mut first, mut rest) = (0, words);
        while let [below @ .., highest] = rest {
            (first, rest) = (*highest, below);
            if first != 0 {
                break;
            }
        }
        let bytes = &mut self.bytes[..];
        let mut place = put_number(bytes, self.len, first);
        for &word in rest.iter().rev() {
            put_word(bytes, place, word);
            place += 64;
        }
        put(bytes, place, &(tail.line >> 8).to_le_bytes());
        self.len = place + tail.len();
    }
}

/// Writes a `b` and a word without leading zeros, and returns the end position.
#[inline(always)]
fn put_number(bytes: &mut [u8], at: usize, value: u64) -> usize {
    put(bytes, at, b"b");
    let width = u64::BITS - (value | 1).leading_zeros();
    let (mut digits, mut place) = (value << (u64::BITS - width), at + 1);
    let end = place + width as usize;
    while place < end {
        put(bytes, place, &eight((digits >> 56) as u8));
        (digits, place) = (digits << 8, place + 8);
    }
    end
}

/// Writes the 64 digits of a word; most words of a delay line are all zeros or ones.
#[inline(always)]
fn put_word(bytes: &mut [u8], at: usize, word: u64) {
    if word == 0 || word == u64::MAX {
        put(bytes, at, &[b'0' | (word & 1) as u8; 64]);
    } else {
        for (place, byte) in word.to_be_bytes().into_iter().enumerate() {
            put(bytes, at + 8 * place, &eight(byte));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(fill: impl FnOnce(&mut Text)) -> String {
        let (mut text, mut out) = (Text::new(4096), Vec::new());
        fill(&mut text);
        text.write(&mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn times_are_spelled_as_rust_spells_them() {
        let times = [0, 5, 2_500, 999_999, 1_000_000, 1_000_007, 1_002_000, 2_345_678_901];
        for time in times.into_iter().chain([u64::MAX, 77, u64::MAX - 1_000_000, 10_000_000]) {
            assert_eq!(text(|text| text.stamp(time)), format!("#{time}\n"));
        }
        let both = text(|text| times.iter().for_each(|&time| text.stamp(time)));
        assert_eq!(both, times.map(|time| format!("#{time}\n")).concat());
    }

    #[test]
    fn values_are_spelled_without_leading_zeros() {
        let tail = Tail::new(" !\n");
        for value in [0, 1, 2, 0xb2, 0x1ff, 1 << 63, u64::MAX, 0x0123_4567_89ab_cdef] {
            assert_eq!(text(|text| text.number(value, tail)), format!("b{value:b} !\n"));
            let long = text(|text| text.vector(&[u64::MAX, 3, value, 0, 0], tail));
            let expected = match value {
                0 => format!("b11{:064b} !\n", u64::MAX),
                _ => format!("b{value:b}{:064b}{:064b} !\n", 3, u64::MAX),
            };
            assert_eq!(long, expected);
        }
        assert_eq!(text(|text| text.vector(&[0; 13], tail)), "b0 !\n");
        assert_eq!(text(|text| text.bit(1, Tail::new("a!\n"))), "1a!\n");
    }

    #[test]
    fn taps_are_spelled_as_their_bits() {
        let tail = Tail::new(" !\n");
        let cases: [&[usize]; 6] = [&[], &[1], &[129], &[64, 128], &[3, 63, 64, 127], &[7, 8, 129]];
        for (ranks, level) in cases.into_iter().flat_map(|ranks| [(ranks, false), (ranks, true)]) {
            let taps = Thermometer::new(level, ranks.iter().copied());
            let mut words = [0; 3];
            taps.expand(130, &mut words);
            let expected = text(|text| text.vector(&words, tail));
            assert_eq!(text(|text| text.taps(&taps, 130, tail)), expected, "{ranks:?}");
        }
    }
}
