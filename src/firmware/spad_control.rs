//! Resets the SPADs before each shot and selects a row of the array.
//!
//! Mirrors `rtl_ref/spad_control.v`. In MODE 0 `spad_rst` is `pre_start` one cycle later: high for
//! exactly the 8 ns that end with the laser edge (thesis 6.4, Table 6.2). In MODE 1 it stays low.

use crate::kernel::scan::Place;
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
        /// Row that acquires.
        #[only_if(Scanned)]
        pub row: Place,
    }
}

signals! {
    /// Registers, all output ports.
    pub struct SpadControl {
        /// Recharges the SPAD and keeps it off.
        pub spad_rst: bool,
        /// Row of the array, one-hot.
        pub spad_sel: U<40> = U::new(1),
    }
}

impl In {
    /// Returns the word that selects its row.
    #[inline(always)]
    fn selected(&self) -> U<40> {
        U::new(1 << self.row.get())
    }
}

impl SpadControl {
    /// Stands for an edge without reset after which the same row acquires.
    #[inline(always)]
    pub fn recharge(&mut self, i: &In) {
        self.spad_rst = i.pre_start & !i.mode;
    }

    /// Returns whether [`SpadControl::recharge`] changes nothing.
    #[inline(always)]
    pub fn is_recharged(&self, i: &In) -> bool {
        self.spad_rst == (i.pre_start && !i.mode)
    }
}

impl Clocked for SpadControl {
    type In = In;
    type Params = ();

    #[inline(always)]
    fn tick(&mut self, i: &In, (): &()) {
        self.recharge(i);
        self.spad_sel = i.selected();
        if i.rst {
            *self = Self::default();
        }
    }

    #[inline(always)]
    fn quiet(&self, i: &In, (): &()) -> u64 {
        asleep_if(!i.rst && self.is_recharged(i) && self.spad_sel == i.selected())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_mode_0_resets_the_spad() {
        let idle = SpadControl::default();
        let row = U::new(0);
        let next = |mode| idle.next(&In { rst: false, mode, pre_start: true, row }, &());
        assert!(next(false).spad_rst);
        assert!(!next(true).spad_rst);
        assert_eq!(next(false).spad_sel, 1);
    }

    #[test]
    fn the_row_that_acquires_is_selected() {
        let i = In { row: U::new(39), ..In::default() };
        assert_eq!(SpadControl::default().next(&i, &()).spad_sel, 1 << 39);
    }
}
