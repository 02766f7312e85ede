//! Digits of numbers, most significant first, and bits of taps.

use bitvec::prelude::*;

use crate::firmware::tdc_decoder::{Decoder, Encoder};
use crate::kernel::thermometer::CAPACITY;
use crate::kernel::{Thermometer, ones_width, partial_highest, partial_ones};

/// Returns the binary digits of a byte, most significant first.
#[inline(always)]
pub(super) fn eight(byte: u8) -> [u8; 8] {
    // Nine apart, eight copies of the byte do not meet; bit 7 of place k is the byte's bit 7 - k.
    let copies = u64::from(byte).wrapping_mul(0x8040_2010_0804_0201);
    (copies >> 7 & 0x0101_0101_0101_0101 | 0x3030_3030_3030_3030).to_le_bytes()
}

/// The three decimal digits of each number below 1000, and a line feed.
pub(super) static THREE_DIGITS: [[u8; 4]; 1000] = {
    let mut table = [[b'\n'; 4]; 1000];
    let mut number = 0;
    while number < table.len() {
        let digits = [number / 100, number / 10 % 10, number % 10];
        let mut place = 0;
        while place < digits.len() {
            table[number][place] = b'0' + digits[place] as u8;
            place += 1;
        }
        number += 1;
    }
    table
};

/// Converter between a thermometer code and the taps in physical order.
#[derive(Clone, Debug, Default)]
pub struct TapDigits {
    /// Physical tap at each position in order of arrival; empty if the orders are equal.
    order: Vec<u16>,
    /// All taps, in order of arrival.
    arrived: BitVec<u64>,
    /// All taps in physical order, if it differs from the order of arrival.
    taps: BitVec<u64>,
    /// The decoder's codes of groups of taps.
    counts: Vec<u64>,
    decoder: Decoder,
}

/// Bits in words, least significant first.
#[derive(Clone, Copy, Debug)]
pub struct Bits<'a> {
    pub words: &'a [u64],
    /// Number of bits.
    pub width: usize,
}

impl TapDigits {
    /// Creates a converter for a delay line with the given decoder.
    pub fn new(encoder: &Encoder) -> Self {
        let (order, decoder) = (encoder.order(), encoder.decoder());
        let arrived = bitvec![u64, Lsb0; 0; order.len()];
        let order = if order.is_sorted() { Vec::new() } else { order.to_vec() };
        let taps = bitvec![u64, Lsb0; 0; order.len()];
        TapDigits { taps, order, arrived, counts: Vec::new(), decoder }
    }

    /// Returns the number of taps if they arrive in physical order.
    #[inline]
    pub(super) fn in_order(&self) -> Option<usize> {
        self.order.is_empty().then_some(self.arrived.len())
    }

    /// Returns the taps, physical tap 0 first, or the decoder's code of each `group` of taps.
    pub fn bits(&mut self, value: &Thermometer, group: usize) -> Bits<'_> {
        let count = self.arrived.len();
        value.expand(count, self.arrived.as_raw_mut_slice());
        for (&tap, level) in self.order.iter().zip(&self.arrived) {
            self.taps.set(tap.into(), *level);
        }
        let taps = if self.order.is_empty() { &self.arrived } else { &self.taps };
        if group == 1 {
            return Bits { words: taps.as_raw_slice(), width: count };
        }
        self.counts.clear();
        let counts = &mut self.counts;
        match self.decoder {
            Decoder::Ones => partial_ones(taps.as_raw_slice(), count, group, counts),
            Decoder::Leading => partial_highest(taps.as_raw_slice(), count, group, counts),
            Decoder::Reordered => {
                partial_highest(self.arrived.as_raw_slice(), count, group, counts)
            }
        }
        Bits { words: counts, width: count.div_ceil(group) * ones_width(group) }
    }

    /// Converts bits, physical tap 0 first and without bits beyond the last tap, to a thermometer code. Returns
    /// `None` if the level changes more often along the taps than any modelled chain allows.
    pub fn taps(&mut self, words: impl Iterator<Item = u64>) -> Option<Thermometer> {
        let into = if self.order.is_empty() { &mut self.arrived } else { &mut self.taps };
        into.as_raw_mut_slice().iter_mut().zip(words).for_each(|(into, word)| *into = word);
        for (&tap, mut arrived) in self.order.iter().zip(self.arrived.iter_mut()) {
            *arrived = self.taps[usize::from(tap)];
        }
        let (first, count) = (self.arrived.first().is_some_and(|level| *level), self.arrived.len());
        let mut level = first;
        let (mut ranks, mut changes) = ([0; CAPACITY], 0);
        for (begin, word) in (0..).step_by(64).zip(self.arrived.as_raw_slice()) {
            let mut left = word ^ (word << 1 | u64::from(level));
            level = word >> 63 == 1;
            while left != 0 {
                let rank = begin + left.trailing_zeros() as usize;
                // Where the taps end there is no change.
                if rank < count {
                    *ranks.get_mut(changes)? = rank;
                    changes += 1;
                }
                left &= left - 1;
            }
        }
        Some(Thermometer::new(first, ranks.into_iter().take(changes)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digits(order: &[u16]) -> TapDigits {
        TapDigits::new(&Encoder::of_order(Decoder::Ones, order))
    }

    #[test]
    fn a_register_of_the_decoder_shows_what_it_makes_of_a_group() {
        // Of eight taps, 2, 0 and 3 are high, the first three that are reached.
        let (order, taps) = ([2, 0, 3, 1, 5, 4, 7, 6], Thermometer::new(true, [3]));
        let shown = Decoder::ALL.map(|decoder| {
            let mut digits = TapDigits::new(&Encoder::of_order(decoder, &order));
            let Bits { words, width } = digits.bits(&taps, 4);
            (words[0] & 7, words[0] >> 3, width)
        });
        assert_eq!(shown, [(3, 0, 6), (4, 0, 6), (3, 0, 6)]);
    }

    /// Packs bits into words, least significant first.
    fn packed(bits: impl IntoIterator<Item = bool>) -> Vec<u64> {
        bits.into_iter().collect::<BitVec<u64>>().into_vec()
    }

    /// Formats the taps as text, physical tap 0 last.
    fn text(digits: &mut TapDigits, taps: &Thermometer) -> String {
        let Bits { words, width } = digits.bits(taps, 1);
        (0..width)
            .rev()
            .map(|tap| if words[tap / 64] >> (tap % 64) & 1 == 1 { '1' } else { '0' })
            .collect()
    }

    #[test]
    fn tap_0_is_the_last_digit() {
        let taps = Thermometer::new(true, [3]);
        let order: Vec<u16> = (0..70).collect();
        assert_eq!(text(&mut digits(&order), &taps), format!("{:070b}", 7));
    }

    #[test]
    fn taps_reached_out_of_order_stand_in_their_physical_place() {
        let mut own = digits(&[2, 0, 3, 1]);
        assert_eq!(text(&mut own, &Thermometer::new(true, [1])), "0100");
        assert_eq!(text(&mut own, &Thermometer::new(true, [3])), "1101");
        assert_eq!(text(&mut own, &Thermometer::new(false, [2])), "1010");
        assert_eq!(text(&mut own, &Thermometer::new(true, [1, 3])), "0110");
        assert_eq!(text(&mut own, &Thermometer::settled(true)), "1111");
        assert_eq!(text(&mut own, &Thermometer::settled(false)), "0000");
    }

    #[test]
    fn bits_give_the_taps_that_show_them() {
        for order in
            [vec![2, 0, 3, 1, 5, 4, 7, 6], (0..130).map(|place| place * 37 % 130).collect()]
        {
            let mut own = digits(&order);
            let levels = [true, false].into_iter();
            let cases = levels.flat_map(|level| {
                [vec![], vec![1], vec![3, 4], vec![2, 5, 7]].map(|ranks| (level, ranks))
            });
            for (level, ranks) in cases {
                let taps = Thermometer::new(level, ranks);
                let text = text(&mut own, &taps);
                let words = packed(text.chars().rev().map(|digit| digit == '1'));
                assert_eq!(own.taps(words.into_iter()), Some(taps), "{text}");
            }
        }
        let mut long = digits(&(0..32).collect::<Vec<_>>());
        let alternating = packed((0..32).map(|tap| tap % 2 == 1));
        assert_eq!(long.taps(alternating.into_iter()), None);
        // Transitions at a word's border and at the last tap, and taps that end with a word.
        for (count, ranks) in [(492, vec![63, 64, 65, 128, 320, 491]), (128, vec![64, 127])] {
            let mut own = digits(&(0..count).collect::<Vec<_>>());
            for level in [true, false] {
                let taps = Thermometer::new(level, ranks.clone());
                let words = own.bits(&taps, 1).words.to_vec();
                assert_eq!(own.taps(words.into_iter()), Some(taps));
            }
        }
    }

    #[test]
    fn many_taps_out_of_order_stand_where_one_by_one_would_put_them() {
        let order: Vec<u16> = (0..130).map(|place| place * 37 % 130).collect();
        let mut own = digits(&order);
        for (level, ranks) in [(true, [1, 64, 65]), (false, [63, 100, 129]), (true, [7, 8, 9])] {
            let taps = Thermometer::new(level, ranks);
            let mut expected = ['0'; 130];
            for (place, &tap) in order.iter().enumerate() {
                expected[129 - tap as usize] = if taps.tap(place) { '1' } else { '0' };
            }
            assert_eq!(text(&mut own, &taps), String::from_iter(expected));
        }
    }
}
