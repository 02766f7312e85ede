//! A double-data-rate output register (ODDR).
//!
//! Mirrors `rtl_ref/ddr_output.v`. `d`, taken at a rising edge of `clk_laser`, is at the output: bit 0 until
//! the falling edge, bits 0 and 1 from there on. A pulse of half a cycle needs no bit 1, and the output is low there.
//! So a pulse has no glitch, whatever the logic before it does.

use crate::kernel::U;
use crate::signals;

signals! {
    /// Input ports.
    pub struct In {
        /// Levels for the first half of the coming cycle and for its second.
        #[size(Halves)]
        pub d: U<2>,
        /// The output is low, asynchronous.
        #[only_if(Hosted)]
        pub off: bool,
        /// Levels of `d` that do not pass.
        #[only_if(Hosted)]
        #[size(Halves)]
        pub block: U<2>,
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
        let d = i.d.get() & !i.block.get();
        DdrOutput { q: d & 1 == 1, second: U::new(d & d >> 1) }.settled(i)
    }

    /// Low while it is off, without an edge.
    #[inline(always)]
    pub fn settled(&self, i: &In) -> Self {
        if i.off { DdrOutput::default() } else { *self }
    }

    /// After a falling edge.
    #[inline(always)]
    pub fn fall(&self) -> Self {
        DdrOutput { q: self.second == 1, ..*self }
    }
}
