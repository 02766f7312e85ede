//! Resets the SPAD before each shot and selects one out of the array.
//!
//! Mirrors `rtl_ref/spad_control.v`. In MODE 0 `spad_rst` is `pre_start` one cycle later: high for
//! exactly the 8 ns that end with the laser edge (thesis 6.4, Table 6.2). In MODE 1 it stays low.

use crate::kernel::{Clocked, U, asleep_if};
use crate::signals;

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// Quench mode.
        pub mode: bool,
        /// Two cycles before the laser edge.
        pub pre_start: bool,
    }
}

signals! {
    /// Registers, all output ports.
    pub struct SpadControl {
        /// Recharges the SPAD and keeps it off.
        pub spad_rst: bool,
        /// Row of the array, one-hot; row 0 is the one in use.
        pub spad_sel: U<40> = U::new(1),
    }
}

impl Clocked for SpadControl {
    type In = In;
    type Params = ();

    #[inline(always)]
    fn tick(&mut self, i: &In, (): &()) {
        self.spad_rst = i.pre_start & !i.mode;
        if i.rst {
            *self = Self::default();
        }
    }

    #[inline(always)]
    fn quiet(&self, i: &In, (): &()) -> u64 {
        asleep_if(!i.rst && self.spad_rst == (i.pre_start && !i.mode))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_mode_0_resets_the_spad() {
        let idle = SpadControl::default();
        let next = |mode| idle.next(&In { rst: false, mode, pre_start: true }, &());
        assert!(next(false).spad_rst);
        assert!(!next(true).spad_rst);
        assert_eq!(next(false).spad_sel, 1);
    }
}
