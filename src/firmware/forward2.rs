//! The output layer: one multiply-accumulate unit (U_S3 with MEM3, thesis Fig. 6.19c).
//!
//! Mirrors `rtl_ref/forward2.v`. One neuron an edge, then the bias as a last product, 4096 x B2.

use crate::kernel::{Clocked, S, U};
use crate::signals;

/// Neurons of the hidden layer unless elaboration says otherwise: the thesis's.
pub const NEURONS: usize = 8;
/// Most neurons that elaboration can ask for: so many have ports.
pub const MOST_NEURONS: usize = 16;
/// Aligns B2 (17 fraction bits) with the depth (29).
const BIAS_FACTOR: i64 = 1 << 12;

/// Activation of a hidden neuron.
pub type L1Out = S<16, 15>;
/// Depth word [m].
pub type Depth = S<36, 29>;

/// MEM3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rom {
    /// Neurons of the hidden layer.
    pub neurons: usize,
    /// W2 as integers, 14 fraction bits; zero past the last neuron.
    pub w2: [S<16>; MOST_NEURONS],
    /// B2 as an integer, 17 fraction bits.
    pub b2: S<16>,
}

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// Accumulates.
        pub forward2_en: bool,
        /// Neuron to add; 0 begins the sum, the one past the last is the bias, then the sum holds.
        pub neuron: U<5>,
        /// Activations of the hidden layer.
        pub l1_out: [L1Out; MOST_NEURONS],
    }
}

signals! {
    /// Registers, all output ports.
    pub struct Forward2 {
        /// The depth, when `algo_done` is high; before that, a partial sum.
        pub depth: Depth,
    }
}

impl Clocked for Forward2 {
    type In = In;
    type Params = Rom;

    #[inline]
    fn next(&self, i: &In, rom: &Rom) -> Self {
        let (q, mut d) = (self, *self);
        let neuron = i.neuron.index();
        if i.forward2_en && neuron < rom.neurons {
            let sum = if neuron == 0 { Depth::new(0) } else { q.depth };
            d.depth = sum + i.l1_out[neuron].get() * rom.w2[neuron].get();
        } else if i.forward2_en && neuron == rom.neurons {
            d.depth = q.depth + BIAS_FACTOR * rom.b2.get();
        }
        if i.rst { Self::default() } else { d }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_for_each_neuron_and_the_bias_make_the_depth() {
        let l1_out = std::array::from_fn(|k| S::new(k as i64 + 1));
        for (neurons, sum) in [(8, 36), (16, 136), (1, 1)] {
            let rom = Rom { neurons, w2: [S::new(2); MOST_NEURONS], b2: S::new(-1) };
            let mut forward2 = Forward2 { depth: S::new(999) };
            for neuron in 0..neurons as u64 + 4 {
                let i = In { rst: false, forward2_en: true, neuron: U::new(neuron), l1_out };
                forward2 = forward2.next(&i, &rom);
            }
            assert_eq!(forward2.depth.get(), 2 * sum - 4096);
        }
    }
}
