//! The output layer: two multiply-accumulate units (U_S3 with MEM3, thesis Fig. 6.19c).
//!
//! Mirrors `rtl_ref/forward2.v`. One unit takes the even neurons and begins with the bias, one the odd
//! ones. Operands, products and sums are registers, so that a unit is one DSP48E1 with all of its registers;
//! only the depth has a reset, because nothing else is looked at without an enable.

use crate::kernel::{Clocked, S, U, wrapped};
use crate::signals;

use super::depth_estimator::datapath::Datapath;

/// Neurons of the hidden layer unless elaboration says otherwise: the thesis's.
pub const NEURONS: usize = 8;
/// Most neurons that elaboration can ask for: so many have ports.
pub const MOST_NEURONS: usize = 32;
/// Multiply-accumulate units.
const UNITS: usize = 2;

/// Activation of a hidden neuron; 15 of its bits are fraction in the thesis.
pub type L1Out = S<24, 15>;
/// A weight or a bias as an integer.
pub type Weight = S<24>;
/// An activation times its weight; 29 of its bits are fraction in the thesis.
pub type Term = S<48, 29>;
/// Accumulator of a unit, with as many fraction bits.
pub type Sum = S<53, 29>;
/// Depth word [m].
pub type Depth = S<36, 29>;

/// MEM3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rom {
    /// Neurons of the hidden layer.
    pub neurons: usize,
    /// W2 as integers; zero past the last neuron.
    pub w2: [Weight; MOST_NEURONS],
    /// B2 as an integer.
    pub b2: Weight,
    /// Their formats, and that of the activations.
    pub datapath: Datapath,
}

impl Rom {
    /// Returns the start value of the sums.
    pub fn bias(&self) -> i64 {
        self.b2.get() << self.datapath.output_bias_shift()
    }

    /// A sum that wraps as one of this datapath.
    fn sum(&self, sum: i64) -> Sum {
        Sum::new(wrapped(sum, self.datapath.output_sum_bits()))
    }
}

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// Neurons whose activations become operands: twice this, and the next.
        #[size(PairBits)]
        pub pair: U<4>,
        /// The sums begin.
        pub forward2_first: bool,
        /// Accumulates.
        pub forward2_en: bool,
        /// The sums become the depth.
        pub depth_en: bool,
        /// Activations of the hidden layer.
        #[count(Neurons)]
        #[size(ActivationBits)]
        pub l1_out: [L1Out; MOST_NEURONS],
    }
}

signals! {
    /// Registers; the public one is the output port.
    pub struct Forward2 {
        /// The depth, from `algo_done` until the next one [m].
        pub depth: Depth,
        /// Activations to multiply.
        #[size(ActivationBits)]
        activation: [L1Out; UNITS],
        /// Their weights.
        #[size(W2Bits)]
        w2: [Weight; UNITS],
        /// Their products, a cycle later.
        #[size(TermBits)]
        term: [Term; UNITS],
        /// Their sums, a cycle later.
        #[size(OutputSumBits)]
        sum: [Sum; UNITS],
    }
}

impl Clocked for Forward2 {
    type In = In;
    type Params = Rom;

    #[inline]
    fn next(&self, i: &In, rom: &Rom) -> Self {
        let (q, mut d) = (self, *self);
        let begins = [Sum::new(rom.bias()), Sum::new(0)];
        for (unit, begin) in begins.into_iter().enumerate() {
            let neuron = UNITS * i.pair.index() + unit;
            let is_there = neuron < rom.neurons;
            d.activation[unit] = if is_there { i.l1_out[neuron] } else { L1Out::new(0) };
            d.w2[unit] = rom.w2[neuron];
            d.term[unit] = Term::new(q.activation[unit].get() * q.w2[unit].get());
            if i.forward2_en {
                let sum = if i.forward2_first { begin } else { q.sum[unit] };
                d.sum[unit] = rom.sum(sum.get() + q.term[unit].get());
            }
        }
        if i.depth_en {
            d.depth = Depth::new(rom.datapath.depth(q.sum[0].get() + q.sum[1].get()));
        }
        if i.rst {
            d.depth = Depth::new(0);
        }
        d
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_for_each_neuron_and_the_bias_make_the_depth() {
        for (neurons, sum) in [(8, 36), (16, 136), (32, 528), (7, 28), (1, 1)] {
            let l1_out = std::array::from_fn(|k| S::new(k as i64 + 1));
            let w2 = std::array::from_fn(|k| S::new(if k < neurons { 2 } else { 0 }));
            let rom = Rom { neurons, w2, b2: S::new(-1), datapath: Datapath::THESIS };
            let pairs = neurons.div_ceil(2) as u64;
            let mut forward2 = Forward2 { depth: S::new(999), ..Forward2::default() };
            for cycle in 0..pairs + 3 {
                let i = In {
                    rst: false,
                    pair: U::new(cycle.min(pairs - 1)),
                    forward2_first: cycle == 2,
                    forward2_en: (2..pairs + 2).contains(&cycle),
                    depth_en: cycle == pairs + 2,
                    l1_out,
                };
                forward2 = forward2.next(&i, &rom);
            }
            assert_eq!(forward2.depth.get(), 2 * sum - 4096);
        }
    }
}
