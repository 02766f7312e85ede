//! The JSON object of a frame.

use serde::Serialize;

use tofsim::firmware::histogram_builder::BINS;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;
use tofsim_learn::estimation::Reading;

use super::pairs::{PlaceInPair, as_sequence};

/// One frame.
#[derive(Clone, Debug, Serialize)]
pub struct FrameSummary {
    /// From 0.
    pub index: u64,
    /// Distance of the target [m]; null where no light was simulated.
    pub true_depth_m: Option<f64>,
    /// Estimated depth [m].
    pub depth_m: f64,
    /// The 36 bits of the depth word in hexadecimal.
    pub depth_raw: String,
    /// Shots counted.
    pub shots: u64,
    /// Hits in the histogram.
    pub hits: u64,
    /// Hits that the TDC kept, with a code or without.
    pub tdc_hits: u64,
    /// Counts [hits].
    #[serde(serialize_with = "as_sequence")]
    pub histogram: [u16; BINS],
    /// From the edge that takes `algo_start` to the one that raises `algo_done` [cycles].
    pub estimator_cycles: u64,
    /// From the edge that begins Clear to the one that raises `algo_done` [cycles].
    pub frame_cycles: u64,
    /// The frame's place in a pair, where frames come in pairs.
    #[serde(flatten)]
    pub paired: Option<PlaceInPair>,
    /// What other estimators say of the histogram.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub estimates: Vec<Reading>,
}

impl FrameSummary {
    /// Of a frame of `setup`, its place in a pair, and of which other estimators say that.
    pub fn new(
        setup: &Setup,
        frame: &Frame,
        paired: Option<PlaceInPair>,
        estimates: Vec<Reading>,
    ) -> Self {
        FrameSummary {
            index: frame.index,
            true_depth_m: setup.true_depth_m(),
            depth_m: frame.depth_m(),
            depth_raw: format!("{:09x}", frame.depth.bits()),
            shots: frame.shots,
            hits: frame.hits(),
            tdc_hits: frame.tdc_hits,
            histogram: frame.histogram,
            estimator_cycles: frame.estimator_cycles,
            frame_cycles: frame.frame_cycles,
            paired,
            estimates,
        }
    }
}
