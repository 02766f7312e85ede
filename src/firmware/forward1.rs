//! The hidden layer: one multiply-accumulate unit a neuron (U_S1 with MEM1, thesis Fig. 6.19a).
//!
//! Mirrors `rtl_ref/forward1.v`. Word and weight, product, and sum are registers each, so that a unit is
//! one DSP48E1 with all of its registers; the ROM is a block RAM and has one of its own. A sum begins with
//! the bias, so that no cycle is spent on it. Only the sums have a reset: nothing else is looked at
//! without an enable.

use crate::kernel::{Clocked, S, wrapped};
use crate::signals;

use super::depth_estimator::datapath::Datapath;
use super::forward2::MOST_NEURONS;
use super::histogram_builder::{self, Bin, Count};

/// Units that are worked on together: neurons come in groups of so many.
const LANES: usize = 8;

/// A weight or, in the last row, a bias, as an integer.
pub type Weight = S<24>;
/// A weight times a word.
pub type Product = S<49>;
/// Accumulator of a neuron, with the fraction bits of its weights: 23 as in the thesis.
pub type L1In = S<57, 23>;
/// A weight for each neuron, zero past the last one, so that the units there stay at zero.
pub type Row = [Weight; MOST_NEURONS];

/// MEM1.
#[derive(Clone, Debug, PartialEq)]
pub struct Rom {
    /// Weights, a row for each word of the histogram.
    pub w1: Vec<Row>,
    /// Biases.
    pub b1: Row,
    /// Neurons, rounded up to whole groups.
    lanes: usize,
    /// Width of a sum [bits].
    sum_bits: u32,
    /// Aligns a bias with a sum.
    bias_shift: u32,
}

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
        #[size(BinBits)]
        pub rom_addr: Bin,
        /// Word of the histogram [hits].
        #[size(CountBits)]
        pub count: Count,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Forward1 {
        /// Sums of the neurons.
        #[count(Neurons)]
        #[size(SumBits)]
        #[view(heading = "Hidden layer", curve = true, probe = true)]
        pub l1_in: [L1In; MOST_NEURONS],
        /// Word of the histogram [hits].
        #[size(CountBits)]
        pub(crate) word: Count,
        /// Output of the ROM.
        #[count(Neurons)]
        #[size(W1Bits)]
        pub(crate) fetched: [Weight; MOST_NEURONS],
        /// Weights of the word.
        #[count(Neurons)]
        #[size(W1Bits)]
        pub(crate) weight: [Weight; MOST_NEURONS],
        /// Their products, a cycle later.
        #[count(Neurons)]
        #[size(ProductBits)]
        pub(crate) product: [Product; MOST_NEURONS],
    }
}

impl Rom {
    /// Of a network of so many neurons, in such a datapath, for such a histogram.
    pub fn new(
        w1: Vec<Row>,
        b1: Row,
        neurons: usize,
        datapath: &Datapath,
        histogram: &histogram_builder::Params,
    ) -> Self {
        let (sum_bits, bias_shift) = (datapath.sum_bits(histogram), datapath.hidden_bias_shift());
        Rom { w1, b1, lanes: neurons.next_multiple_of(LANES), sum_bits, bias_shift }
    }

    /// Width of a sum [bits].
    pub fn sum_bits(&self) -> u32 {
        self.sum_bits
    }

    /// Returns the start value of a neuron's sum.
    pub fn bias(&self, neuron: usize) -> L1In {
        L1In::new(self.b1[neuron].get() << self.bias_shift)
    }

    /// A sum that wraps as one of that width.
    #[inline(always)]
    pub fn sum(&self, sum: i64) -> L1In {
        L1In::new(wrapped(sum, self.sum_bits))
    }
}

impl Forward1 {
    /// With those sums, while nothing is read: the same word has come for three cycles.
    pub(crate) fn at_rest(l1_in: [L1In; MOST_NEURONS], word: Count, rom: &Rom) -> Self {
        let [first, ..] = rom.w1[..] else { return Forward1::default() };
        let product = first.map(|weight| Product::new(weight.get() * word.get() as i64));
        Forward1 { l1_in, word, fetched: first, weight: first, product }
    }
}

impl Clocked for Forward1 {
    type In = In;
    type Params = Rom;

    #[inline]
    fn tick(&mut self, i: &In, rom: &Rom) {
        if i.forward1_en {
            let sums = self.l1_in.iter_mut().zip(&self.product).take(rom.lanes);
            for (neuron, (l1_in, product)) in sums.enumerate() {
                let sum = if i.forward1_first { rom.bias(neuron) } else { *l1_in };
                *l1_in = rom.sum(sum.get() + product.get());
            }
        }
        let (word, row) = (self.word.get() as i64, &rom.w1[i.rom_addr.index()][..rom.lanes]);
        let registers = self.product.iter_mut().zip(&mut self.weight).zip(&mut self.fetched);
        for (((product, weight), fetched), next) in registers.zip(row) {
            *product = Product::new(weight.get() * word);
            *weight = *fetched;
            *fetched = *next;
        }
        self.word = i.count;
        if i.rst {
            self.l1_in = Default::default();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::U;

    #[test]
    fn a_sum_begins_with_the_bias_and_its_first_product_three_edges_after_the_word() {
        let (mut w1, mut b1) = (vec![Row::default(); 16], Row::default());
        (w1[0][2], w1[1][2], b1[2]) = (S::new(-3), S::new(7), S::new(5));
        let histogram = histogram_builder::Params { bins: 16, count_bits: 16 };
        let rom = Rom::new(w1, b1, 8, &Datapath::THESIS, &histogram);
        let mut block = Forward1::default();
        block.l1_in[..8].fill(S::new(77));
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
