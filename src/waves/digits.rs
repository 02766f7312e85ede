//! Binary digits of words and taps, most significant first.

use bitvec::prelude::*;

use crate::kernel::Thermometer;

/// The eight digits of each byte.
const EIGHT: [[u8; 8]; 256] = {
    let mut table = [[b'0'; 8]; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut place = 0;
        while place < 8 {
            table[byte][place] += (byte >> (7 - place)) as u8 & 1;
            place += 1;
        }
        byte += 1;
    }
    table
};

/// The 64 digits of a word.
#[inline]
pub(super) fn of_word(value: u64) -> [u8; 64] {
    let mut digits = [0; 64];
    for (eight, byte) in digits.chunks_exact_mut(8).zip(value.to_be_bytes()) {
        eight.copy_from_slice(&EIGHT[byte as usize]);
    }
    digits
}

/// Spells the taps of a delay line, physical tap 0 last.
#[derive(Debug)]
pub(crate) struct TapDigits {
    /// Physical tap at each place in the order of arrival; empty if that is the same order.
    order: Vec<u16>,
    arrived: BitVec<u64>,
    taps: BitVec<u64>,
    digits: Vec<u8>,
}

impl TapDigits {
    /// For lines whose taps are reached in `order`.
    pub(crate) fn new(order: &[u16]) -> Self {
        let sorted = order.iter().enumerate().all(|(place, &tap)| place == tap as usize);
        TapDigits {
            order: if sorted { Vec::new() } else { order.to_vec() },
            arrived: BitVec::new(),
            taps: BitVec::new(),
            digits: Vec::new(),
        }
    }

    /// The `N` digits.
    pub(super) fn of<const N: usize>(&mut self, value: &Thermometer<N>) -> &[u8] {
        self.expand(value);
        let taps = if self.order.is_empty() { &self.arrived } else { &self.taps };
        self.digits.clear();
        for &word in taps.as_raw_slice().iter().rev() {
            self.digits.extend_from_slice(&of_word(word));
        }
        &self.digits[self.digits.len() - N..]
    }

    /// The `N` bits in words, physical tap 0 the lowest.
    pub(crate) fn words<const N: usize>(&mut self, value: &Thermometer<N>) -> &[u64] {
        self.expand(value);
        let taps = if self.order.is_empty() { &mut self.arrived } else { &mut self.taps };
        taps.set_uninitialized(false);
        taps.as_raw_slice()
    }

    fn expand<const N: usize>(&mut self, value: &Thermometer<N>) {
        if self.arrived.len() != N {
            self.arrived.resize(N, false);
            self.taps.resize(N, false);
        }
        value.expand(&mut self.arrived);
        if !self.order.is_empty() {
            for (arrived, &tap) in self.arrived.iter().by_vals().zip(&self.order) {
                self.taps.set(tap as usize, arrived);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(digits: &[u8]) -> String {
        String::from_utf8(digits.to_vec()).unwrap()
    }

    #[test]
    fn words_are_spelled_as_rust_spells_them() {
        for value in [0, 1, 0xb2, 1 << 63, u64::MAX, 0x0123_4567_89ab_cdef] {
            assert_eq!(text(&of_word(value)), format!("{value:064b}"));
        }
    }

    #[test]
    fn tap_0_is_the_last_digit() {
        let taps = Thermometer::<70>::new(true, [3]);
        assert_eq!(text(TapDigits::new(&[]).of(&taps)), format!("{:070b}", 7));
    }

    #[test]
    fn taps_reached_out_of_order_stand_in_their_physical_place() {
        let mut digits = TapDigits::new(&[2, 0, 3, 1]);
        assert_eq!(text(digits.of(&Thermometer::<4>::new(true, [1]))), "0100");
        assert_eq!(text(digits.of(&Thermometer::<4>::new(true, [3]))), "1101");
        assert_eq!(text(digits.of(&Thermometer::<4>::new(false, [2]))), "1010");
    }
}
