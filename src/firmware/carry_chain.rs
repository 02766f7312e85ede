//! The tapped delay line of the TDC: taps of carry logic, all registered at every edge.
//!
//! Mirrors `rtl_ref/carry_chain.v`. Tap i sees `tdc_stop` after the chain's offset and the delays
//! of taps 0 .. i - 1; an arrival at or before the edge counts. The line is longer than a clock
//! period, so several transitions may travel in it.

use crate::signals;

mod delays;
mod transitions;

pub use delays::{Delays, LENGTHS, TAPS, Taps};
pub use transitions::{MAX_TRANSITIONS, Transitions};

signals! {
    /// Input ports.
    pub struct In {
        /// Output of the SPAD, asynchronous.
        pub tdc_stop: bool,
    }
}

signals! {
    /// Registers, all output ports.
    pub struct CarryChain {
        /// Level of each tap at the last edge.
        #[size(Taps)]
        #[view(heading = "TDC")]
        pub taps: Taps,
    }
}
