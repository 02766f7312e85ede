//! The numbers of a design that its sizes follow from.

use crate::kernel::word_format::WordFormat;

use super::likelihood;

/// Independent numbers of a design, from which every [`Size`] follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// Taps of the delay chain.
    pub taps: u32,
    /// Bits of the coarse count.
    pub coarse_bits: u32,
    /// Clock period [time units of the decoder].
    pub cycle: u32,
    /// Binary digits of a time below a bin.
    pub digits: u32,
    /// Bits of an age in the calibration ROM.
    pub age_bits: u32,
    /// Registers of the ones count.
    pub count_stages: u32,
    /// True if a host controls the firmware through registers.
    pub hosted: bool,
    /// True if the firmware calibrates its TDC.
    pub calibrates: bool,
    /// Rows of the array.
    pub rows: u32,
    /// Columns of the array.
    pub columns: u32,
    /// Banks of histograms.
    pub banks: u32,
    /// Hits of a calibration, as a power of two.
    pub hits_log2: u32,
    /// Laser rates to choose from.
    pub rates: u32,
    /// Longest laser period [cycles of clk_sys].
    pub longest_period: u32,
    /// Length of the laser pulse [half cycles of clk_laser].
    pub pulse_half_cycles: u32,
    /// Length of Drain [cycles of clk_sys].
    pub drain_cycles: u32,
    /// Bins of the histogram, a power of two.
    pub bins: u32,
    /// Bits of a bin count.
    pub count_bits: u32,
    /// Hidden neurons.
    pub neurons: u32,
    /// Format of the hidden layer's weights.
    pub w1: WordFormat,
    /// Format of the hidden layer's biases.
    pub b1: WordFormat,
    /// Format of the output layer's weights.
    pub w2: WordFormat,
    /// Format of the output layer's bias.
    pub b2: WordFormat,
    /// Format of an activation.
    pub activation: WordFormat,
    /// Bits of an address of the activation table.
    pub address_bits: u32,
    /// Range of the activation table: minus to plus two to this power.
    pub range_log2: u32,
    /// Bits of a sum of the hidden layer.
    pub sum_bits: u32,
    /// Bits of a sum of the output layer.
    pub output_sum_bits: u32,
    /// Latency of the network [cycles of clk_sys].
    pub network_cycles: u32,
    /// Latency of the centroid estimator [cycles of clk_sys].
    pub centroid_cycles: u32,
    /// Bits of the centroid estimator's position.
    pub position_bits: u32,
    /// True if the likelihood estimator knows of a cover glass.
    pub has_glass: bool,
    /// True if the likelihood estimator looks for a second target.
    pub has_second: bool,
    /// Latency of the likelihood estimator [cycles of clk_sys].
    pub likelihood_cycles: u32,
}

impl Sizes {
    /// Bits of a bin's number.
    pub(super) fn bin_bits(&self) -> u32 {
        self.bins.ilog2()
    }

    /// Bits of a sum of all bin counts.
    pub(super) fn rest_bits(&self) -> u32 {
        self.count_bits + self.bin_bits()
    }

    /// Bits of a weight of the likelihood estimator.
    pub(super) fn weight_bits(&self) -> u32 {
        likelihood::weight_bits(self.count_bits)
    }

    /// Bits of a word of its solver.
    pub(super) fn word_bits(&self) -> u32 {
        likelihood::word_bits(self.bin_bits(), self.count_bits)
    }
}
