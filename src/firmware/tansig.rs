//! The activation of the hidden layer, from a table (U_S2 with MEM2).
//!
//! Mirrors `rtl_ref/tansig.v`. Two edges: the table's own register, then that of the activations. The
//! address is the only rounding in the datapath: the sum, rounded half up to the table's step and
//! saturated to its range; in the thesis to 9 fraction bits and +-4.

use std::sync::{Arc, LazyLock};

use crate::kernel::{Clocked, S};
use crate::signals;

use super::depth_estimator::datapath::Datapath;
use super::forward1::L1In;
use super::forward2::{L1Out, MOST_NEURONS};

/// MEM2.
#[derive(Clone, Debug, PartialEq)]
pub struct Rom {
    /// Activations by address as an unsigned word: entry 0 is tanh(0) = 0, as unused units have it; the one in
    /// the middle is the most negative.
    pub entries: Vec<L1Out>,
    /// Fraction bits of a sum that the address drops.
    pub shift: u32,
}

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// Looks up the activations.
        pub tansig_en: bool,
        /// Sums of the neurons.
        #[count(Neurons)]
        #[size(SumBits)]
        pub l1_in: [L1In; MOST_NEURONS],
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Tansig {
        /// Activations of the neurons.
        #[count(Neurons)]
        #[size(ActivationBits)]
        #[view(heading = "Hidden layer")]
        pub l1_out: [L1Out; MOST_NEURONS],
        /// Output of the table.
        #[count(Neurons)]
        #[size(ActivationBits)]
        entry: [L1Out; MOST_NEURONS],
        /// The entries are new.
        found: bool,
    }
}

impl Rom {
    /// The table of a datapath. That of the thesis's formats is made only once.
    pub fn of(datapath: &Datapath) -> Arc<Self> {
        static THESIS: LazyLock<Arc<Rom>> = LazyLock::new(|| Arc::new(Rom::new(&Datapath::THESIS)));
        if *datapath == Datapath::THESIS { THESIS.clone() } else { Arc::new(Rom::new(datapath)) }
    }

    fn new(datapath: &Datapath) -> Self {
        let entries = datapath.table().into_iter().map(S::new).collect();
        Rom { entries, shift: datapath.shift() }
    }

    /// Place in the table of the activation of `l1_in`.
    pub fn address(&self, l1_in: L1In) -> usize {
        let rounded = (l1_in.get() + (1 << (self.shift - 1))) >> self.shift;
        let limit = self.entries.len() as i64 / 2;
        rounded.clamp(-limit, limit - 1) as usize & (self.entries.len() - 1)
    }

    /// The activation of `l1_in`.
    pub fn activation(&self, l1_in: L1In) -> L1Out {
        self.entries[self.address(l1_in)]
    }
}

impl Clocked for Tansig {
    type In = In;
    type Params = Rom;

    #[inline]
    fn tick(&mut self, i: &In, rom: &Rom) {
        if i.rst {
            self.l1_out = Default::default();
        } else if self.found {
            self.l1_out = self.entry;
        }
        if i.tansig_en {
            self.entry = i.l1_in.map(|l1_in| rom.activation(l1_in));
        }
        self.found = i.tansig_en && !i.rst;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_address_rounds_half_up_and_saturates() {
        let rom = Rom::new(&Datapath::THESIS);
        let at = |l1_in: i64| rom.address(S::new(l1_in));
        assert_eq!(at(8191), 0);
        assert_eq!(at(8192), 1);
        assert_eq!(at(-8192), 0);
        assert_eq!(at(-8193), 4095);
        assert_eq!(at((1 << 35) - 1), 2047);
        assert_eq!(at(-(1 << 35)), 2048);
        assert_eq!(at((2047 << 14) + 8191), 2047);
        assert_eq!(at(-(2048 << 14)), 2048);
    }
}
