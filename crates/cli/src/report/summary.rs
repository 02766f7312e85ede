//! The JSON object of a run, around its frames.

use serde::Serialize;

use tofsim::firmware::histogram_builder::BINS;
use tofsim::network::formats::Depth;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;
use tofsim::sim::shot_recorder::Shot;
use tofsim_learn::estimation::Reading;

use super::frame_log::FrameLog;
use super::pairs::{Paired, Pairs, Tally};

/// What `run --json` prints and `summary.json` holds, but for the frames.
#[derive(Clone, Debug)]
pub struct Summary {
    head: Head,
    /// Results of the TDC, where the scenario asks for them.
    pub tdc: Option<Vec<TdcSummary>>,
}

/// What stands before the frames.
#[derive(Clone, Debug, Serialize)]
struct Head {
    /// `tofsim.run/1`.
    schema: &'static str,
    /// Version of the program.
    version: &'static str,
    /// Scenario's name.
    scenario: String,
    /// Seed of every random stream.
    seed: u64,
    /// How the run was simulated.
    fidelity: &'static str,
    /// The waveform.
    waves: Option<String>,
    /// Mean and spread, where there is more than one frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    depth: Option<Spread>,
    /// How many pairs, and what subtraction made of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pairs: Option<Tally>,
    /// The frames, which are written in between.
    frames: [(); 0],
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
    /// The frame's place in a pair, where frames come in pairs.
    #[serde(flatten)]
    pub paired: Option<Paired>,
    /// What other estimators say of the histogram.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub estimates: Vec<Reading>,
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

/// How the frames begin in the text of a [`Head`], and end it.
const NO_FRAMES: &str = "[]}";

impl Summary {
    /// Of a run of `setup`.
    pub fn new(
        setup: &Setup,
        fidelity: &'static str,
        waves: Option<String>,
        log: &FrameLog,
        shots: &[Shot],
    ) -> Self {
        let head = Head {
            schema: "tofsim.run/1",
            version: env!("CARGO_PKG_VERSION"),
            scenario: setup.name.clone(),
            seed: setup.scenario.seed,
            fidelity,
            waves,
            depth: log.spread(),
            pairs: log.pairs.as_ref().map(Pairs::tally),
            frames: [],
        };
        let tdc = setup.scenario.report.tdc.then(|| shots.iter().map(TdcSummary::new).collect());
        Summary { head, tdc }
    }

    /// One line of JSON in two parts, between which the frames go.
    pub(super) fn around_frames(&self) -> serde_json::Result<(String, String)> {
        let mut head = serde_json::to_string(&self.head)?;
        head.truncate(head.len() - NO_FRAMES.len() + 1);
        let tdc = self.tdc.as_ref().map(serde_json::to_string).transpose()?;
        let tdc = tdc.map_or(String::new(), |tdc| format!(",\"tdc\":{tdc}"));
        Ok((head, format!("]{tdc}}}\n")))
    }
}

impl Spread {
    /// From the number of frames and the sums of their depth words and of the squares of those;
    /// `None` for fewer than two frames. All exact but the last divisions.
    pub fn of(count: u64, (sum, squares): (i128, i128)) -> Option<Self> {
        if count < 2 {
            return None;
        }
        let lsb_m = 1.0 / (1u64 << Depth::FRAC_NBITS) as f64;
        let n = i128::from(count);
        let variance = (n * squares - sum * sum) as f64 / (n as f64 * (n - 1) as f64);
        let mean_m = sum as f64 / count as f64 * lsb_m;
        Some(Spread { mean_m, two_sd_m: 2.0 * variance.sqrt() * lsb_m })
    }
}

impl FrameSummary {
    /// Of a frame of `setup`, its place in a pair, and of which other estimators say that.
    pub fn new(
        setup: &Setup,
        frame: &Frame,
        paired: Option<Paired>,
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

fn serialize_histogram<S: serde::Serializer>(
    histogram: &[u16; BINS],
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    serializer.collect_seq(histogram)
}
