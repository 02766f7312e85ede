//! The JSON object of a run.

use serde::Serialize;

use crate::error::{Input, Result};
use crate::firmware::histogram_builder::BINS;
use crate::network::formats::Depth;
use crate::sim::frames::Frame;
use crate::sim::recorder::Shot;
use crate::sim::setup::Setup;

/// What `run --json` prints and `summary.json` holds.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// `tofsim.run/1`.
    pub schema: &'static str,
    /// Version of the program.
    pub version: &'static str,
    /// Scenario's name.
    pub scenario: String,
    /// Seed of every random stream.
    pub seed: u64,
    /// How the run was simulated.
    pub fidelity: &'static str,
    /// The waveform.
    pub waves: Option<String>,
    /// Mean and spread, where there is more than one frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<Spread>,
    /// The frames.
    pub frames: Vec<FrameSummary>,
    /// Results of the TDC, where the scenario asks for them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tdc: Option<Vec<TdcSummary>>,
}

/// Depth over the frames of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Mean [m].
    pub mean_m: f64,
    /// Two standard deviations, with n - 1 [m].
    pub two_sd_m: f64,
}

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
    #[serde(serialize_with = "serialize_histogram")]
    pub histogram: [u16; BINS],
    /// From the edge that takes `algo_start` to the one that raises `algo_done` [cycles].
    pub estimator_cycles: u64,
    /// From the edge that begins Clear to the one that raises `algo_done` [cycles].
    pub frame_cycles: u64,
}

/// One result of the TDC, in the words of thesis Table 6.3.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TdcSummary {
    /// From start to stop [ps].
    pub t2_ps: Option<f64>,
    /// Carry cells passed.
    pub n: Option<u64>,
    /// From start to the clock edge after stop [ns].
    pub t1_ns: Option<u64>,
    /// Whether the result has a code.
    pub valid: bool,
}

impl Summary {
    /// Of a run of `setup`.
    pub fn new(setup: &Setup, waves: Option<String>, frames: &[Frame], shots: &[Shot]) -> Self {
        Summary {
            schema: "tofsim.run/1",
            version: env!("CARGO_PKG_VERSION"),
            scenario: setup.name.clone(),
            seed: setup.scenario.seed,
            fidelity: "cycle",
            waves,
            depth: spread(frames),
            frames: frames.iter().map(|frame| FrameSummary::new(setup, frame)).collect(),
            tdc: setup.scenario.report.tdc.then(|| shots.iter().map(TdcSummary::new).collect()),
        }
    }
}

impl Summary {
    /// As one line of JSON.
    pub fn json(&self) -> Result<String> {
        let text = serde_json::to_string(self).map_err(|error| Input::new("--json", error))?;
        Ok(text + "\n")
    }
}

impl FrameSummary {
    fn new(setup: &Setup, frame: &Frame) -> Self {
        FrameSummary {
            index: frame.index,
            true_depth_m: setup.true_depth_m(),
            depth_m: depth_m(frame),
            depth_raw: format!("{:09x}", frame.depth.bits()),
            shots: frame.shots,
            hits: frame.hits(),
            tdc_hits: frame.tdc_hits,
            histogram: frame.histogram,
            estimator_cycles: frame.estimator_cycles,
            frame_cycles: frame.frame_cycles,
        }
    }
}

impl TdcSummary {
    fn new(shot: &Shot) -> Self {
        TdcSummary {
            t2_ps: shot.arrival_fs.map(|fs| fs as f64 / 1e3),
            n: shot.n,
            t1_ns: shot.coarse.map(|coarse| 8 * (coarse + 1)),
            valid: shot.code.is_some(),
        }
    }
}

/// The depth word in metres.
pub fn depth_m(frame: &Frame) -> f64 {
    Depth::from_bits(frame.depth.get()).to_num()
}

/// Mean and spread of the depths of two frames or more.
pub fn spread(frames: &[Frame]) -> Option<Spread> {
    if frames.len() < 2 {
        return None;
    }
    let count = frames.len() as f64;
    let mean_m = frames.iter().map(depth_m).sum::<f64>() / count;
    let squares: f64 = frames.iter().map(|frame| (depth_m(frame) - mean_m).powi(2)).sum();
    Some(Spread { mean_m, two_sd_m: 2.0 * (squares / (count - 1.0)).sqrt() })
}

fn serialize_histogram<S: serde::Serializer>(
    histogram: &[u16; BINS],
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    serializer.collect_seq(histogram)
}
