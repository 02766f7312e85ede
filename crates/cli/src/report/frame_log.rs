//! The frames of a run as they come: what the reports need of them, in little memory.

use std::io::{self, Seek, Write};
use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;
use serde::Serialize;
use tempfile::SpooledTempFile;

use tofsim::Note;
use tofsim::error::{Error, Input, Result};
use tofsim::firmware::depth_estimator::datapath::DEPTH_FRACTION;
use tofsim::scenario::glass::GlassTemplate;
use tofsim::sim::frames::Frame;
use tofsim::sim::second_opinion::SecondOpinion;
use tofsim::sim::setup::Setup;
use tofsim_learn::estimation::notes::PedestalWatch;
use tofsim_learn::estimation::{Estimate, Panel};

use super::pairs::{PairLog, PlaceInPair};
use super::statistics::{EstimatorStatistics, Judge, OpinionStatistics, Opinions, Tally};

/// Frames of which a table has rows.
pub const ROWS: usize = 20;

/// Frames that wait for each other, so that all threads give second opinions on them.
const WAITING: usize = 64;

/// JSON that is kept in memory; more of it goes to a temporary file [bytes].
const KEPT: usize = 1 << 20;

/// Depth over the frames of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DepthSpread {
    /// Mean [m].
    pub mean_m: f64,
    /// Two standard deviations, with n - 1 [m].
    pub two_sd_m: f64,
    /// True distance; none where no light was simulated [m].
    pub true_depth_m: Option<f64>,
    /// Mean less the true distance [m].
    pub mean_error_m: Option<f64>,
    /// Depths that are further off than the limit, or negative.
    pub outliers: u64,
}

/// The frames of a run so far.
#[derive(Default)]
pub struct FrameLog {
    /// The first frames, [`ROWS`] at most.
    pub rows: Vec<Frame>,
    /// Results of other estimators for these frames.
    pub readings: Vec<Vec<Estimate>>,
    /// Second opinions on those.
    pub opinions: Vec<Option<Estimate>>,
    /// Number of frames.
    pub count: u64,
    /// The pairs that the frames make, if they make pairs.
    pub pairs: Option<PairLog>,
    panel: Panel,
    judge: Judge,
    second_true_m: Option<f64>,
    outliers: u64,
    tally: Tally,
    second: Opinions,
    waiting: Vec<Waiting>,
    /// Sums of the depth words and of their squares, which no order of summing changes.
    sums: (i128, i128),
    /// Whether the frames are those of a board.
    is_measured: bool,
    /// The cover window's light, if there is a template of it.
    glass: Option<Arc<GlassTemplate>>,
    pedestals: PedestalWatch,
    /// The frames as elements of a JSON array, if they are wanted.
    json: Option<SpooledTempFile>,
}

/// A frame of which all is known but the second opinion.
struct Waiting {
    frame: Frame,
    paired: Option<PlaceInPair>,
    estimates: Vec<Estimate>,
}

impl FrameLog {
    /// Without frames of `setup`; `json` if [`FrameLog::copy_json`] will be called. The estimators of
    /// `panel` look at every frame or pair; a depth is an outlier that is further off than `limit_m`
    /// [m]. `second` gives second opinions.
    pub fn new(
        setup: &Setup,
        json: bool,
        (panel, second): (Panel, Option<SecondOpinion>),
        limit_m: f64,
    ) -> Self {
        FrameLog {
            pairs: setup.has_pairs().then(|| PairLog::new(setup)),
            panel,
            judge: Judge { truth_m: setup.true_depth_m(), limit_m },
            second_true_m: setup.true_depths().and_then(|truth| truth.second_m),
            second: Opinions::new(second),
            json: json.then(|| SpooledTempFile::new(KEPT)),
            glass: setup.glass.clone(),
            ..FrameLog::default()
        }
    }

    /// Takes the frames for those of a board: nobody knows the true distance, nor what is not in its registers.
    pub fn measured(mut self) -> Self {
        (self.judge.truth_m, self.second_true_m) = (None, None);
        FrameLog { is_measured: true, ..self }
    }

    /// Takes the next frame; [`FrameLog::settle`] has to be called after the last one.
    ///
    /// # Errors
    /// When the temporary file cannot be written.
    pub fn push(&mut self, frame: &Frame) -> Result<()> {
        let (paired, estimates) = match &mut self.pairs {
            Some(pairs) => pairs.take(frame, &self.panel),
            None => (None, self.panel.read(&frame.histogram)),
        };
        self.waiting.push(Waiting { frame: frame.clone(), paired, estimates });
        if self.waiting.len() < WAITING { Ok(()) } else { self.settle() }
    }

    /// Takes the frames that still wait for others.
    ///
    /// # Errors
    /// When the temporary file cannot be written.
    pub fn settle(&mut self) -> Result<()> {
        let waiting = std::mem::take(&mut self.waiting);
        let opinion = |waiting: &Waiting| self.second.of(&waiting.frame);
        let opinions: Vec<_> = waiting.par_iter().map(opinion).collect();
        waiting.into_iter().zip(opinions).try_for_each(|(next, opinion)| {
            self.second.add(&next.frame, opinion.as_ref());
            self.take(next, opinion)
        })
    }

    fn take(&mut self, next: Waiting, opinion: Option<Estimate>) -> Result<()> {
        let Waiting { frame, paired, estimates } = next;
        self.outliers += u64::from(self.judge.is_outlier(frame.depth_m()));
        self.tally.add(&estimates, &self.judge);
        self.pedestals.add(&estimates);
        if self.rows.len() < ROWS {
            self.rows.push(frame.clone());
            self.readings.push(estimates.clone());
            self.opinions.push(opinion.clone());
        }
        let depth = i128::from(frame.depth().to_bits());
        self.sums = (self.sums.0 + depth, self.sums.1 + depth * depth);
        let simulated = |count: u64| (!self.is_measured).then_some(count);
        if let Some(json) = &mut self.json {
            let summary = FrameSummary {
                index: frame.index,
                true_depth_m: self.judge.truth_m,
                second_true_depth_m: self.second_true_m,
                estimate: frame.estimate(),
                shots: frame.shots,
                hits: frame.hits(),
                tdc_hits: simulated(frame.tdc_hits),
                histogram: &frame.histogram,
                estimator_cycles: simulated(frame.estimator_cycles),
                frame_cycles: simulated(frame.frame_cycles),
                second_opinion: opinion,
                paired,
                estimates,
            };
            let comma = if self.count > 0 { "," } else { "" };
            let text =
                serde_json::to_string(&summary).map_err(|fault| Input::new("--json", fault))?;
            let written = write!(json, "{comma}{text}");
            written.map_err(Error::io(Path::new("temporary file"), "write"))?;
        }
        self.count += 1;
        Ok(())
    }

    /// Mean and spread of the depths of two frames or more; those of pairs are in
    /// [`FrameLog::pairs`].
    pub fn spread(&self) -> Option<DepthSpread> {
        let (mean_m, two_sd_m) = moments_m(self.count, self.sums)?;
        let spread = DepthSpread {
            mean_m,
            two_sd_m,
            true_depth_m: self.judge.truth_m,
            mean_error_m: self.judge.error_m(mean_m),
            outliers: self.outliers,
        };
        self.pairs.is_none().then_some(spread)
    }

    /// Returns the statistics of other estimators over at least two frames or pairs.
    pub fn estimators(&self) -> Vec<EstimatorStatistics> {
        self.tally.statistics(&self.judge)
    }

    /// Returns the statistics of second opinions over at least two frames.
    pub fn second_opinion(&self) -> Option<OpinionStatistics> {
        self.second.statistics(&self.judge)
    }

    /// Returns the notes on second opinions, and on a cover window's light.
    pub fn notes(&self) -> Vec<Note> {
        let mut notes = self.second.notes();
        notes.extend(self.glass.as_ref().and_then(|glass| self.pedestals.note(glass)));
        notes
    }

    /// Copies what has been written of the frames, between commas.
    ///
    /// # Errors
    /// When reading the temporary file fails, or writing to `out`.
    pub fn copy_json(&mut self, out: &mut impl Write) -> io::Result<()> {
        let Some(json) = &mut self.json else { return Ok(()) };
        json.rewind()?;
        io::copy(json, out).map(drop)
    }
}

/// Mean and two standard deviations, from the number of frames and the sums of their depth words and
/// of the squares of those; `None` for fewer than two frames. All exact but the last divisions [m].
fn moments_m(count: u64, (sum, squares): (i128, i128)) -> Option<(f64, f64)> {
    if count < 2 {
        return None;
    }
    let lsb_m = 1.0 / (1u64 << DEPTH_FRACTION) as f64;
    let n = i128::from(count);
    let variance = (n * squares - sum * sum) as f64 / (n as f64 * (n - 1) as f64);
    let mean_m = sum as f64 / count as f64 * lsb_m;
    Some((mean_m, 2.0 * variance.sqrt() * lsb_m))
}

/// The JSON object of a frame.
#[derive(Serialize)]
struct FrameSummary<'a> {
    index: u64,
    /// Null where no light was simulated, and of a board.
    true_depth_m: Option<f64>,
    /// Of the second target, where the firmware looks for one.
    #[serde(skip_serializing_if = "Option::is_none")]
    second_true_depth_m: Option<f64>,
    /// The estimate of the firmware.
    #[serde(flatten)]
    estimate: Estimate,
    shots: u64,
    hits: u64,
    /// Hits that the TDC kept, with a code or without; null of a board, as the cycles are.
    tdc_hits: Option<u64>,
    histogram: &'a [u32],
    /// From the edge that takes `algo_start` to the one that raises `algo_done` [cycles].
    estimator_cycles: Option<u64>,
    /// From the edge that begins Clear to the one that raises `algo_done` [cycles].
    frame_cycles: Option<u64>,
    /// Null where nobody gives one.
    second_opinion: Option<Estimate>,
    /// The frame's place in a pair, where frames come in pairs.
    #[serde(flatten)]
    paired: Option<PlaceInPair>,
    /// Results of other estimators for the histogram.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    estimates: Vec<Estimate>,
}
