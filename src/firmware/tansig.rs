//! The activation of the hidden layer, from a table (U_S2 with MEM2).
//!
//! Mirrors `rtl_ref/tansig.v`. Two edges: the table's own register, then that of the activations. The
//! address is the only rounding in the datapath: the sum, rounded half up to 9 fraction bits and
//! saturated to +-4.

use crate::kernel::Clocked;
use crate::signals;

use super::forward1::L1In;
use super::forward2::{L1Out, MOST_NEURONS};

/// Address bits of the table.
pub const ADDRESS_BITS: u32 = 12;
/// Fraction bits that the address drops: 23 of the sum less 9.
const SHIFT: u32 = 14;
/// Entries of the table.
pub const ENTRIES: usize = 1 << ADDRESS_BITS;

/// MEM2, by address as an unsigned word: entry 0 is tanh(0) = 0, as unused units have it; entry 2048
/// is the most negative.
pub type Rom = [L1Out; ENTRIES];

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// Looks up the activations.
        pub tansig_en: bool,
        /// Sums of the neurons.
        #[size("Neurons SumBits")]
        pub l1_in: [L1In; MOST_NEURONS],
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Tansig {
        /// Activations of the neurons.
        #[size("Neurons")]
        #[view(heading = "Hidden layer")]
        pub l1_out: [L1Out; MOST_NEURONS],
        /// Output of the table.
        #[size("Neurons")]
        entry: [L1Out; MOST_NEURONS],
        /// The entries are new.
        found: bool,
    }
}

/// Place in the table of the activation of `l1_in`.
pub fn address(l1_in: L1In) -> usize {
    let rounded = (l1_in.get() + (1 << (SHIFT - 1))) >> SHIFT;
    let limit = 1 << (ADDRESS_BITS - 1);
    rounded.clamp(-limit, limit - 1) as usize & (ENTRIES - 1)
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
            self.entry = i.l1_in.map(|l1_in| rom[address(l1_in)]);
        }
        self.found = i.tansig_en && !i.rst;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::S;

    #[test]
    fn the_address_rounds_half_up_and_saturates() {
        let at = |l1_in: i64| address(S::new(l1_in));
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
