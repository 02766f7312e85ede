//! Stands in for the TDC: a code from a ROM for every shot (thesis 6.6.1).
//!
//! Mirrors `rtl_ref/code_preload.v`. The code is up two edges after the laser edge, the thesis's
//! "10 ns after VCSEL-on" seen by `clk_sys`. The ROM is read in order and again from its start.

use crate::kernel::{Clocked, U, asleep_if};
use crate::signals;

use super::histogram_builder::Bin;

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// A shot begins.
        pub start: bool,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct CodePreload {
        /// `tdc_code` is new; one cycle.
        pub tdc_valid: bool,
        /// Code of the shot [bins].
        #[size(BinBits)]
        pub tdc_code: Bin,
        /// `start`, an edge later.
        pending: bool,
        /// Next word of the ROM.
        rom_addr: U<16>,
    }
}

impl Clocked for CodePreload {
    type In = In;
    /// The ROM, 1 to 65,536 codes.
    type Params = [Bin];

    #[inline(always)]
    fn tick(&mut self, i: &In, rom: &[Bin]) {
        let (q, d) = (*self, self);
        d.pending = i.start;
        d.tdc_valid = q.pending;
        if q.pending {
            d.tdc_code = rom[q.rom_addr.index()];
            let last = q.rom_addr.index() + 1 == rom.len();
            d.rom_addr = if last { U::new(0) } else { q.rom_addr + 1 };
        }
        if i.rst {
            *d = Self::default();
        }
    }

    #[inline(always)]
    fn quiet(&self, i: &In, _: &[Bin]) -> u64 {
        asleep_if(!i.start && !self.pending && !self.tdc_valid && !i.rst)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_shot_has_the_next_code_two_edges_later() {
        let rom = [U::new(7), U::new(200)];
        let mut preload = CodePreload::default();
        let mut codes = Vec::new();
        for cycle in 0..18 {
            let i = In { rst: false, start: cycle % 6 == 0 };
            preload = preload.next(&i, &rom);
            if preload.tdc_valid {
                codes.push((cycle % 6, preload.tdc_code.get()));
            }
        }
        assert_eq!(codes, [(1, 7), (1, 200), (1, 7)]);
    }
}
