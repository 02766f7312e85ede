//! The columns of an array beside the first, and the second bank of that one.

use crate::firmware::carry_chain::Taps;
use crate::firmware::histogram_builder::{self, HistogramBuilder, Registers};
use crate::firmware::tdc::Tdc;
use crate::kernel::scan::Scan;

/// A column with its converter and a histogram for each bank.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Converter.
    pub tdc: Tdc,
    /// Histograms, by bank.
    pub banks: Vec<HistogramBuilder>,
    /// Level of its delay line's taps, as the coming edge samples them.
    pub sampled: Taps,
}

/// Returns the second bank of the first column, which has no words in a design of one bank, and the other columns.
pub(super) fn beside(
    size: &histogram_builder::Params,
    scan: &Scan,
) -> (HistogramBuilder, Vec<Channel>) {
    let empty = || HistogramBuilder::new(size);
    let absent = HistogramBuilder { registers: Registers::default(), ram: Box::default() };
    let second_bank = if scan.banks > 1 { empty() } else { absent };
    let channel = |_| Channel {
        tdc: Tdc::default(),
        banks: (0..scan.banks).map(|_| empty()).collect(),
        sampled: Taps::default(),
    };
    (second_bank, (1..scan.columns).map(channel).collect())
}
