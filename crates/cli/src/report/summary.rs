//! The JSON object of a run, around its frames.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Value, json};

use tofsim::Note;
use tofsim::sim::setup::Setup;
use tofsim::sim::shot_recorder::Shot;

use crate::record::Record;

use super::frame_log::FrameLog;

/// The object of `run --json` and `summary.json`, but for the frames.
#[derive(Clone, Debug)]
pub struct Summary {
    /// The keys before the frames.
    head: Value,
    /// Results of the TDC, where the scenario asks for them.
    pub tdc: Option<Vec<TdcSummary>>,
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
    /// Summarises a run of `setup` at that fidelity, with a waveform in the file `waves`; its record, and
    /// what it lies outside of.
    pub fn new(
        setup: &Setup,
        fidelity: &'static str,
        waves: Option<String>,
        log: &FrameLog,
        shots: &[Shot],
        (record, notes): (&Record, &[Note]),
    ) -> Self {
        let mut head = json!({
            "schema": "tofsim.run/1",
            "version": record.version,
            "scenario": record.scenario,
            "seed": record.seed,
            "fidelity": fidelity,
            "waves": waves,
        });
        record.put_into(&mut head, notes);
        if let Some(depth) = log.spread() {
            head["depth"] = json!(depth);
        }
        if let Some(second) = log.second_opinion() {
            head["second_opinion"] = json!(second);
        }
        let estimators = log.estimators();
        if !estimators.is_empty() {
            head["estimators"] = json!(estimators);
        }
        if let Some(pairs) = &log.pairs {
            head["pairs"] = json!(pairs.statistics());
        }
        let tdc = setup.scenario.report.tdc.then(|| shots.iter().map(TdcSummary::new).collect());
        Summary { head, tdc }
    }

    /// Names the files that belong to the run.
    pub fn list(&mut self, names: Vec<String>) {
        self.head["files"] = json!(names);
    }

    /// Writes the run as one line of JSON, with the frames in it.
    ///
    /// # Errors
    /// When the frames cannot be read back, or nothing be written to `out`.
    pub fn write(&self, log: &mut FrameLog, out: &mut impl Write) -> io::Result<()> {
        let head = self.head.to_string();
        write!(out, "{},\"frames\":[", &head[..head.len() - 1])?;
        log.copy_json(out)?;
        let tdc = self.tdc.as_ref().map_or(String::new(), |tdc| format!(",\"tdc\":{}", json!(tdc)));
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
