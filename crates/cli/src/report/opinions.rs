//! Second opinions on the frames of a run: what reports need of them.

use serde::Serialize;

use tofsim::Note;
use tofsim::sim::estimates::{Estimate, digits};
use tofsim::sim::frames::Frame;
use tofsim::sim::partings::Partings;
use tofsim::sim::second_opinion::{ESTIMATOR, SecondOpinion};

use super::statistics::{Judge, Moments};

/// Who gives second opinions, if anybody does, and what they have come to.
#[derive(Default)]
pub struct Opinions {
    second: Option<SecondOpinion>,
    partings: Partings,
    depths: Moments,
}

/// Statistics of second opinions over at least two frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OpinionStatistics {
    /// Its name on the command line.
    pub estimator: &'static str,
    /// Mean of the depths that are to be believed [m].
    pub mean_m: Option<f64>,
    /// Two standard deviations of them, with n - 1 [m].
    pub two_sd_m: Option<f64>,
    /// Mean less the true distance [m].
    pub mean_error_m: Option<f64>,
    /// Frames of which there is an opinion.
    pub frames: u64,
    /// Frames whose depth in the firmware is further from it than their spreads allow.
    pub parted: u64,
    /// Frames of which no depth is to be believed.
    pub unbelieved: u64,
}

impl Opinions {
    /// Of that estimator, if there is one.
    pub fn new(second: Option<SecondOpinion>) -> Self {
        Opinions { second, ..Opinions::default() }
    }

    /// Returns the second opinion on a frame.
    pub fn of(&self, frame: &Frame) -> Option<Estimate> {
        self.second.as_ref()?.of(frame)
    }

    /// Takes what it said of the next frame.
    pub fn add(&mut self, frame: &Frame, opinion: Option<&Estimate>) {
        let (Some(second), Some(opinion)) = (&self.second, opinion) else { return };
        self.partings.add(second, frame, opinion);
        opinion.depth_m.filter(|_| opinion.valid).into_iter().for_each(|m| self.depths.add(m));
    }

    /// Returns the notes on the second opinions.
    pub fn notes(&self) -> Vec<Note> {
        self.second.as_ref().map_or(Vec::new(), |second| self.partings.notes(second))
    }

    /// Returns the statistics of at least two second opinions.
    pub fn statistics(&self, judge: &Judge) -> Option<OpinionStatistics> {
        let Partings { frames, parted, unbelieved, .. } = self.partings;
        let mean_m = self.depths.mean();
        (frames > 1).then(|| OpinionStatistics {
            estimator: ESTIMATOR,
            mean_m,
            two_sd_m: self.depths.two_sd(),
            mean_error_m: mean_m.and_then(|mean_m| judge.error_m(mean_m)),
            frames,
            parted,
            unbelieved,
        })
    }
}

/// An estimate of the only frame: depth, word, error, and what the estimator states beside them.
pub fn in_words(estimate: &Estimate, truth_m: Option<f64>) -> String {
    let mut text = estimate.depth_m.map_or("none".to_owned(), |m| format!("{m:.6} m"));
    text += &estimate.depth_raw.map_or(String::new(), |word| format!("  {}", digits(word)));
    if let (Some(depth_m), Some(truth_m)) = (estimate.depth_m, truth_m) {
        text += &format!("  {:+.2} mm", 1e3 * (depth_m - truth_m));
    }
    if let Some(sigma_m) = estimate.sigma_m {
        text += &format!("  {}, sd {sigma_m:.6} m", estimate.estimator);
    }
    if !estimate.valid {
        text += &format!(", rejected: {}", estimate.status);
    }
    text
}

/// Formats the statistics on one line.
pub fn line(of: &OpinionStatistics) -> String {
    let mut text = format!("second opinion: {}", of.estimator);
    if let Some(mean_m) = of.mean_m {
        text += &format!(", mean {mean_m:.6} m");
    }
    if let Some(error_m) = of.mean_error_m {
        text += &format!(", error {:+.3} mm", 1e3 * error_m);
    }
    if let Some(two_sd_m) = of.two_sd_m {
        text += &format!(", 2σ {two_sd_m:.6} m");
    }
    let OpinionStatistics { frames, parted, unbelieved, .. } = of;
    text + &format!(
        "\nof {frames} depths {parted} part from it; of {unbelieved} frames it believes none"
    )
}
