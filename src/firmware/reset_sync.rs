//! Brings the reset into one clock domain.
//!
//! Mirrors `rtl_ref/reset_sync.v`. Two flip-flops that start high: the reset holds until the PLL
//! has locked and `rst` is low, and is asserted and released synchronously, two edges later.

use crate::kernel::{Clocked, asleep_if};
use crate::signals;

signals! {
    /// Input ports.
    pub struct In {
        /// Reset button of the board, asynchronous.
        pub rst: bool,
        /// The PLL has locked.
        pub locked: bool,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct ResetSync {
        /// Synchronous reset of the domain, active high.
        pub rst_sync: bool = true,
        /// First flip-flop, which may go metastable on the board.
        meta: bool = true,
    }
}

impl Clocked for ResetSync {
    type In = In;
    type Params = ();

    #[inline(always)]
    fn next(&self, i: &In, (): &()) -> Self {
        ResetSync { rst_sync: self.meta, meta: i.rst | !i.locked }
    }

    #[inline(always)]
    fn quiet(&self, i: &In, (): &()) -> u64 {
        asleep_if(self.next(i, &()) == *self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reset_holds_for_two_edges_after_lock() {
        let reset = ResetSync::default();
        let locked = In { rst: false, locked: true };
        let first = reset.next(&locked, &());
        assert!(first.rst_sync);
        assert!(!first.next(&locked, &()).rst_sync);
    }
}
