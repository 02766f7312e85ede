//! The differential output buffer of the laser pulse (OBUFDS). Not clocked.
//!
//! Mirrors `rtl_ref/lvds_output.v`.

use crate::signals;

signals! {
    /// Input ports.
    pub struct In {
        /// Single-ended pulse.
        pub i: bool,
    }
}

signals! {
    /// Output ports.
    pub struct Out {
        /// Positive pin.
        pub o: bool,
        /// Negative pin.
        pub ob: bool = true,
    }
}

/// The pair of pins.
pub fn out(i: &In) -> Out {
    Out { o: i.i, ob: !i.i }
}
