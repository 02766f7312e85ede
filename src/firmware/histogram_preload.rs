//! Stands in for the histogram: a ROM with the same read port (thesis 6.7.4). Not clocked.
//!
//! Mirrors `rtl_ref/histogram_preload.v`.

use crate::kernel::U;
use crate::signals;

use super::histogram_builder::BINS;

signals! {
    /// Input ports.
    pub struct In {
        /// Word to show.
        pub read_addr: U<8>,
    }
}

signals! {
    /// There are no registers.
    pub struct HistogramPreload {}
}

/// The ROM [hits].
pub type Rom = [U<16>; BINS];

/// Output port `count`: the word at the address, as from the RAM's asynchronous read.
pub fn count(i: &In, rom: &Rom) -> U<16> {
    rom[i.read_addr.index()]
}
