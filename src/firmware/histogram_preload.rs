//! Stands in for the histogram: a ROM with the same read port (thesis 6.7.4). Not clocked.
//!
//! Mirrors `rtl_ref/histogram_preload.v`.

use crate::signals;

use super::histogram_builder::{Bin, Count};

signals! {
    /// Input ports.
    pub struct In {
        /// Word to show.
        #[size(BinBits)]
        pub read_addr: Bin,
    }
}

signals! {
    /// There are no registers.
    pub struct HistogramPreload {}
}

/// The ROM [hits].
pub type Rom = [Count];

/// Output port `count`: the word at the address, as from the RAM's asynchronous read.
pub fn count(i: &In, rom: &Rom) -> Count {
    rom[i.read_addr.index()]
}
