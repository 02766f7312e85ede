//! The hidden layer: one multiply-accumulate unit a neuron (U_S1 with MEM1, thesis Fig. 6.19a).
//!
//! Mirrors `rtl_ref/forward1.v`. Word and weight, product, and sum are registers each, so that a unit is
//! one DSP48E1 with all of its registers; the ROM is a block RAM and has one of its own. A sum begins with
//! the bias, so that no cycle is spent on it. Only the sums have a reset: nothing else is looked at
//! without an enable.

use crate::kernel::{Clocked, S, U};
use crate::signals;

use super::forward2::MOST_NEURONS;
use super::histogram_builder::BINS;

/// Row of the ROM with the biases, after the last weights.
pub const BIAS_ROW: usize = BINS;
/// Aligns B1 (13 fraction bits) with the sum (23).
const BIAS_SHIFT: u32 = 10;

/// A weight or, in the last row, a bias, as an integer.
pub type Weight = S<16>;
/// A weight times a word.
pub type Product = S<33>;
/// Accumulator of a neuron.
pub type L1In = S<36, 23>;
/// MEM1: 256 rows of weights and one of biases; `rom[row][neuron]`, zero past the last neuron, so that
/// the units there stay at zero.
pub type Rom = [[Weight; MOST_NEURONS]; BINS + 1];

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// The sums begin.
        pub forward1_first: bool,
        /// Accumulates.
        pub forward1_en: bool,
        /// Row to fetch: that of the coming word.
        pub rom_addr: U<8>,
        /// Word of the histogram [hits].
        pub count: U<16>,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Forward1 {
        /// Sums of the neurons.
        #[size("Neurons")]
        #[view(heading = "Hidden layer", curve = true, probe = true)]
        pub l1_in: [L1In; MOST_NEURONS],
        /// Word of the histogram [hits].
        pub(crate) word: U<16>,
        /// Output of the ROM.
        #[size("Neurons")]
        pub(crate) fetched: [Weight; MOST_NEURONS],
        /// Weights of the word.
        #[size("Neurons")]
        pub(crate) weight: [Weight; MOST_NEURONS],
        /// Their products, a cycle later.
        #[size("Neurons")]
        pub(crate) product: [Product; MOST_NEURONS],
    }
}

/// What the sum of a neuron begins with.
pub fn bias(rom: &Rom, neuron: usize) -> L1In {
    L1In::new(rom[BIAS_ROW][neuron].get() << BIAS_SHIFT)
}

impl Forward1 {
    /// With those sums, while nothing is read: the same word has come for three cycles.
    pub(crate) fn at_rest(l1_in: [L1In; MOST_NEURONS], word: U<16>, rom: &Rom) -> Self {
        let product = rom[0].map(|weight| Product::new(weight.get() * word.get() as i64));
        Forward1 { l1_in, word, fetched: rom[0], weight: rom[0], product }
    }
}

impl Clocked for Forward1 {
    type In = In;
    type Params = Rom;

    #[inline]
    fn tick(&mut self, i: &In, rom: &Rom) {
        if i.forward1_en {
            for (neuron, l1_in) in self.l1_in.iter_mut().enumerate() {
                let sum = if i.forward1_first { bias(rom, neuron) } else { *l1_in };
                *l1_in = sum + self.product[neuron].get();
            }
        }
        let word = self.word.get() as i64;
        self.product = self.weight.map(|weight| Product::new(weight.get() * word));
        self.weight = self.fetched;
        self.fetched = rom[i.rom_addr.index()];
        self.word = i.count;
        if i.rst {
            self.l1_in = Default::default();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_begins_with_the_bias_and_its_first_product_three_edges_after_the_word() {
        let mut rom = [[S::new(0); MOST_NEURONS]; BINS + 1];
        rom[0][2] = S::new(-3);
        rom[1][2] = S::new(7);
        rom[BIAS_ROW][2] = S::new(5);
        let mut block = Forward1 { l1_in: [S::new(77); MOST_NEURONS], ..Forward1::default() };
        // The address before the word, and the enable two cycles after it.
        let lines = [(0, 9, false), (1, 100, false), (0, 10, false), (0, 8, true), (0, 8, true)];
        for (line, (rom_addr, count, forward1_en)) in lines.into_iter().enumerate() {
            let (rom_addr, count) = (U::new(rom_addr), U::new(count));
            let forward1_first = line == 3;
            block.tick(&In { rst: false, forward1_first, forward1_en, rom_addr, count }, &rom);
        }
        assert_eq!(block.l1_in[2].get(), 1024 * 5 - 3 * 100 + 7 * 10);
        assert_eq!(block.l1_in[0].get(), 0);
    }
}
