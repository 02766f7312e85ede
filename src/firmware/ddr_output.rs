//! A double-data-rate output register (ODDR).
//!
//! Mirrors `rtl_ref/ddr_output.v`. `d`, taken at a rising edge of `clk_laser`, is at the output: bit 0 until
//! the falling edge, bit 1 from there on. A pulse of half a cycle needs no bit 1, and the output is low there.
//! So a pulse has no glitch, whatever the logic before it does.

use crate::kernel::U;
use crate::signals;

signals! {
    /// Input ports.
    pub struct In {
        /// Levels for the first half of the coming cycle and for its second.
        #[size(Halves)]
        pub d: U<2>,
    }
}

signals! {
    /// Registers; the public one is the output port.
    pub struct DdrOutput {
        /// The output.
        pub q: bool,
        /// The output after the falling edge.
        #[size(SecondHalf)]
        second: U<1>,
    }
}

impl DdrOutput {
    /// After a rising edge.
    #[inline(always)]
    pub fn rise(&self, i: &In) -> Self {
        DdrOutput { q: i.d.get() & 1 == 1, second: U::new(i.d.get() >> 1) }
    }

    /// After a falling edge.
    #[inline(always)]
    pub fn fall(&self) -> Self {
        DdrOutput { q: self.second == 1, ..*self }
    }
}
