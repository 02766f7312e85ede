//! The JSON object of a run, around its frames.

use std::io::{self, Write};

use serde::Serialize;

use tofsim::sim::setup::Setup;
use tofsim::sim::shot_recorder::Shot;

use super::frame_log::{DepthSpread, FrameLog};
use super::pairs::{PairLog, PairStatistics};

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
    depth: Option<DepthSpread>,
    /// How many pairs, and what subtraction made of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pairs: Option<PairStatistics>,
    /// The frames, which are written in between.
    frames: [(); 0],
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
            pairs: log.pairs.as_ref().map(PairLog::statistics),
            frames: [],
        };
        let tdc = setup.scenario.report.tdc.then(|| shots.iter().map(TdcSummary::new).collect());
        Summary { head, tdc }
    }

    /// Writes the run as one line of JSON, with the frames in it.
    ///
    /// # Errors
    /// When the frames cannot be read back, or nothing be written to `out`.
    pub fn write(&self, log: &mut FrameLog, out: &mut impl Write) -> io::Result<()> {
        let mut head = serde_json::to_string(&self.head)?;
        head.truncate(head.len() - NO_FRAMES.len() + 1);
        let tdc = self.tdc.as_ref().map(serde_json::to_string).transpose()?;
        let tdc = tdc.map_or(String::new(), |tdc| format!(",\"tdc\":{tdc}"));
        out.write_all(head.as_bytes())?;
        log.copy_json(out)?;
        writeln!(out, "]{tdc}}}")
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
