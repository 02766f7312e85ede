//! The hidden layer: one multiply-accumulate unit a neuron (U_S1 with MEM1, thesis Fig. 6.19a).
//!
//! Mirrors `rtl_ref/forward1.v`. The weights of the coming cycle are fetched into registers, so
//! that the ROM can be a block RAM; product and sum take one edge. The bias goes through the
//! multiplier as a 257th product, 1024 x B1, so that each unit is one DSP48E1.

use crate::kernel::{Clocked, S, U};
use crate::signals;

use super::forward2::MOST_NEURONS;
use super::histogram_builder::BINS;

/// Row of the ROM after the last weight.
pub const BIAS_ROW: usize = BINS;
/// Aligns B1 (13 fraction bits) with the sum (23).
const BIAS_FACTOR: i64 = 1 << 10;

/// A weight or, in the last row, a bias, as an integer.
pub type Weight = S<16>;
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
        /// Accumulates.
        pub forward1_en: bool,
        /// `count` is a word of the histogram; if not, the bias is added.
        pub read_en: bool,
        /// Which word; 0 begins the sum.
        pub read_addr: U<8>,
        /// Row to fetch.
        pub rom_addr: U<9>,
        /// Word of the histogram [hits].
        pub count: U<16>,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Forward1 {
        /// Sums of the neurons.
        #[view(heading = "Hidden layer", curve = true, probe = true)]
        pub l1_in: [L1In; MOST_NEURONS],
        /// Weights of this cycle.
        pub(crate) weight: [Weight; MOST_NEURONS],
    }
}

impl Clocked for Forward1 {
    type In = In;
    type Params = Rom;

    #[inline]
    fn tick(&mut self, i: &In, rom: &Rom) {
        let weight = rom[i.rom_addr.index().min(BIAS_ROW)];
        let operand = if i.read_en { i.count.get() as i64 } else { BIAS_FACTOR };
        let first = i.read_en && i.read_addr == 0;
        if i.forward1_en {
            for (l1_in, weight) in self.l1_in.iter_mut().zip(&self.weight) {
                let sum = if first { L1In::new(0) } else { *l1_in };
                *l1_in = sum + operand * weight.get();
            }
        }
        self.weight = weight;
        if i.rst {
            *self = Self::default();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_product_begins_the_sum_and_the_bias_ends_it() {
        let mut rom = [[S::new(0); MOST_NEURONS]; BINS + 1];
        rom[0][2] = S::new(-3);
        rom[BIAS_ROW][2] = S::new(5);
        let i = In {
            rst: false,
            forward1_en: true,
            read_en: true,
            read_addr: U::new(0),
            rom_addr: U::new(BIAS_ROW as u64),
            count: U::new(100),
        };
        let stale = Forward1 { l1_in: [S::new(77); MOST_NEURONS], weight: rom[0] };
        let product = stale.next(&i, &rom);
        assert_eq!(product.l1_in[2].get(), -300);
        let sum = product.next(&In { read_en: false, ..i }, &rom);
        assert_eq!(sum.l1_in[2].get(), -300 + 1024 * 5);
        assert_eq!(sum.l1_in[0].get(), 0);
    }
}
