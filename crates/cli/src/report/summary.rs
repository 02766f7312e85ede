//! The JSON object of a run, around its frames.

use std::io::{self, Write};

use serde::Serialize;

use tofsim::Note;
use tofsim::sim::setup::Setup;
use tofsim::sim::shot_recorder::Shot;

use crate::record::Record;

use super::frame_log::{DepthSpread, FrameLog};
use super::pairs::{PairLog, PairStatistics};
use super::statistics::{EstimatorStatistics, OpinionStatistics};

/// The object of `run --json` and `summary.json`, but for the frames.
#[derive(Serialize)]
struct Object<'a> {
    schema: &'static str,
    #[serde(flatten)]
    record: &'a Record,
    #[serde(flatten)]
    summary: &'a Summary,
}

/// What a run came to.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// `board`, if the frames are those of a board.
    #[serde(skip_serializing_if = "Option::is_none")]
    source: Option<&'static str>,
    /// The board.
    #[serde(skip_serializing_if = "Option::is_none")]
    board: Option<BoardSummary>,
    /// Simulation fidelity; null of a board.
    fidelity: Option<&'static str>,
    /// File of the waveform.
    waves: Option<String>,
    /// Notes on the validity of the results.
    notes: Vec<Note>,
    #[serde(skip_serializing_if = "Option::is_none")]
    depth: Option<DepthSpread>,
    #[serde(skip_serializing_if = "Option::is_none")]
    second_opinion: Option<OpinionStatistics>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    estimators: Vec<EstimatorStatistics>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pairs: Option<PairStatistics>,
    /// Files that belong to the run, if it has a folder.
    #[serde(skip_serializing_if = "Option::is_none")]
    files: Option<Vec<String>>,
    /// Results of the TDC, where the scenario asks for them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tdc: Option<Vec<TdcSummary>>,
}

/// The board that frames come from.
#[derive(Clone, Debug, Serialize)]
pub struct BoardSummary {
    /// Name of its port.
    pub port: String,
    /// Hash of the parameters that its firmware was built with.
    pub parameters_hash: String,
    /// Whether the laser was armed.
    pub laser: bool,
}

/// One result of the TDC, in the words of thesis Table 6.3.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TdcSummary {
    /// Time from start to stop [ps].
    pub t2_ps: Option<f64>,
    /// Carry cells passed.
    pub n: Option<u64>,
    /// Time from start to the clock edge after stop [ns].
    pub t1_ns: Option<u64>,
    /// Whether the result has a code.
    pub valid: bool,
}

impl Summary {
    /// Summarises a run of `setup` at that fidelity, with a waveform in the file `waves`; what it lies outside of.
    pub fn new(
        setup: &Setup,
        fidelity: &'static str,
        waves: Option<String>,
        log: &FrameLog,
        shots: &[Shot],
        notes: &[Note],
    ) -> Self {
        Summary {
            source: None,
            board: None,
            fidelity: Some(fidelity),
            waves,
            notes: notes.to_vec(),
            depth: log.spread(),
            second_opinion: log.second_opinion(),
            estimators: log.estimators(),
            pairs: log.pairs.as_ref().map(PairLog::statistics),
            files: None,
            tdc: setup.scenario.report.tdc.then(|| shots.iter().map(TdcSummary::new).collect()),
        }
    }

    /// Summarises frames of a board.
    pub fn of_board(board: BoardSummary, log: &FrameLog, notes: &[Note]) -> Self {
        Summary {
            source: Some("board"),
            board: Some(board),
            fidelity: None,
            waves: None,
            notes: notes.to_vec(),
            depth: log.spread(),
            second_opinion: log.second_opinion(),
            estimators: log.estimators(),
            pairs: None,
            files: None,
            tdc: None,
        }
    }

    /// Names the files that belong to the run.
    pub fn list(&mut self, names: Vec<String>) {
        self.files = Some(names);
    }

    /// Writes the run as one line of JSON, with its record, and the frames in it.
    ///
    /// # Errors
    /// When the frames cannot be read back, or nothing be written to `out`.
    pub fn write(
        &self,
        record: &Record,
        log: &mut FrameLog,
        out: &mut impl Write,
    ) -> io::Result<()> {
        let object = Object { schema: "tofsim.run/1", record, summary: self };
        let head = serde_json::to_string(&object)?;
        write!(out, "{},\"frames\":[", &head[..head.len() - 1])?;
        log.copy_json(out)?;
        writeln!(out, "]}}")
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
