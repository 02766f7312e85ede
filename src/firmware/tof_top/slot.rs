//! The estimator slot: what fits it has these ports.

use fixed::types::extra::U29;
use fixed::{FixedI64, FixedU64};

use crate::firmware::forward2::Depth;
use crate::firmware::histogram_builder::{self, Bin, Count};
use crate::kernel::{U, scan};
use crate::signals;

pub use super::status::StatusBits;
use super::status_code::StatusCode;

/// Standard deviation of a depth, with as many fraction bits as the depth word [2^-29 m].
pub type Sigma = U<36>;

signals! {
    /// Input ports of the slot; an estimator has those that it needs.
    pub struct SlotIn {
        /// Synchronous reset.
        pub rst: bool,
        /// Starts an estimation.
        pub algo_start: bool,
        /// SPADs come back by themselves (MODE 1).
        pub mode: bool,
        /// Column of the histogram.
        #[only_if(Scanned)]
        pub depth_column: scan::Place,
        /// Word of the histogram at `read_addr` [hits].
        #[size(CountBits)]
        pub count: Count,
    }
}

signals! {
    /// Input ports of an estimator that needs the histogram only.
    pub struct HistogramIn {
        /// Synchronous reset.
        pub rst: bool,
        /// Starts an estimation.
        pub algo_start: bool,
        /// Word of the histogram at `read_addr` [hits].
        #[size(CountBits)]
        pub count: Count,
    }
}

impl From<SlotIn> for HistogramIn {
    fn from(SlotIn { rst, algo_start, count, .. }: SlotIn) -> Self {
        HistogramIn { rst, algo_start, count }
    }
}

/// Outputs of the estimator in the slot; waveforms show that estimator's own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlotOut {
    /// The histogram's word at `read_addr` is being read.
    pub read_en: bool,
    /// Word of the histogram.
    pub read_addr: Bin,
    /// The estimate, from `algo_done` until the next one.
    pub words: EstimateWords,
    /// The estimate is ready; one cycle.
    pub algo_done: bool,
}

/// Words of an estimate, as the ports have them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EstimateWords {
    /// Distance of the target [m].
    pub depth: Depth,
    /// Its standard deviation; 0 from an estimator that states none.
    pub sigma: Sigma,
    /// Reasons to reject the depth; 0 from an estimator that states none.
    pub status: StatusBits,
    /// The status has no reason to reject the depth; low from an estimator that states none.
    pub valid: bool,
    /// What a host can rely on, in one word; 0 from an estimator that states no status.
    pub code: StatusCode,
    /// The second target; all 0 without one.
    pub second: SecondWords,
}

/// Words of a second target.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SecondWords {
    /// Its distance [m].
    pub second_depth: Depth,
    /// Standard deviation of its distance; 0 without a second target.
    pub second_sigma: Sigma,
    /// Its signal, 14 fraction bits [photons a shot].
    pub second_strength: U<24>,
    /// Reasons to reject its distance.
    pub second_status: StatusBits,
    /// There is a second target, and its status has no reason to reject the distance.
    pub second_valid: bool,
}

/// Distance with the fraction bits of a depth word [m].
pub type DepthM = FixedI64<U29>;
/// Standard deviation with as many fraction bits [m].
pub type SigmaM = FixedU64<U29>;

impl EstimateWords {
    /// Words of an estimator that states only a depth.
    pub fn of_depth(depth: Depth) -> Self {
        EstimateWords { depth, ..EstimateWords::default() }
    }

    /// Distance of the target [m].
    pub fn depth_m(&self) -> DepthM {
        DepthM::from_bits(self.depth.get())
    }

    /// Its standard deviation [m].
    pub fn sigma_m(&self) -> SigmaM {
        SigmaM::from_bits(self.sigma.get())
    }
}

/// Assumptions of an estimator about the histogram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assumptions {
    /// The echo is where the hits are.
    Peak,
    /// The histogram is like those that the estimator was trained with.
    Training,
    /// Pulse, ambient light and pile-up are those of the instrument's model.
    Model,
}

/// An estimator that fits the slot.
pub trait SlotEstimator: Default {
    /// Its input ports.
    type In: From<SlotIn> + PartialEq;
    /// Parameters fixed by elaboration.
    type Params: Clone + std::fmt::Debug + Send + Sync;
    /// Whether the estimator outputs a sigma, a status and `valid` beside the depth.
    const STATES_SIGMA: bool = false;
    /// Assumptions that its depth rests on.
    const ASSUMES: Assumptions = Assumptions::Peak;

    /// Parameters for histograms of that size, as they are without a scenario.
    fn params_for(histogram: &histogram_builder::Params) -> Self::Params;

    /// The rising edge of `clk_sys`.
    fn rise(&mut self, i: &Self::In, p: &Self::Params);

    /// Its output ports.
    fn outputs(&self) -> SlotOut;

    /// From the edge that takes `algo_start` to the one that raises `algo_done` [cycles of clk_sys].
    fn cycles(p: &Self::Params) -> u64;

    /// Cycles since the edge that took `algo_start`, up to the cycle of `algo_done`; an estimator may stop counting
    /// at 1 [cycles of clk_sys].
    fn phase(&self, p: &Self::Params) -> Option<u64>;

    /// Whether no edge changes anything until an input does.
    fn rests(&self, i: &Self::In, p: &Self::Params) -> bool;
}
