//! A double-data-rate output register (ODDR with its second input tied low).
//!
//! Mirrors `rtl_ref/ddr_output.v`. `d`, taken at a rising edge of `clk_laser`, is at the output
//! until the falling edge; then the output is low. So the pulse is half a cycle long and has no
//! glitch, whatever the logic before it does.

use crate::signals;

signals! {
    /// Input ports.
    pub struct In {
        /// Level for the first half of the coming cycle.
        pub d: bool,
    }
}

signals! {
    /// The register, which is the output port.
    pub struct DdrOutput {
        /// The output.
        pub q: bool,
    }
}

impl DdrOutput {
    /// After a rising edge.
    #[inline(always)]
    pub fn rise(&self, i: &In) -> Self {
        DdrOutput { q: i.d }
    }

    /// After a falling edge.
    #[inline(always)]
    pub fn fall(&self) -> Self {
        DdrOutput { q: false }
    }
}
