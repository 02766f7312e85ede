//! Statistics of the depths of a run: mean and spread, outliers and failures; and second opinions on its frames.

use serde::Serialize;

use tofsim::Note;
use tofsim::Setup;
use tofsim::sim::disagreements::Disagreements;
use tofsim::sim::estimates::{Estimate, digits};
use tofsim::sim::frames::Frame;
use tofsim::sim::second_opinion::{ESTIMATOR, SecondOpinion};
use tofsim::sim::setup::truth::TrueDepths;
use tofsim_learn::evaluation::spread::is_outlier;

use crate::text::table::{counted, grouped, signed};
use crate::verbs::terminal::Console;

/// Criteria for outliers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Judge {
    /// True distance; none where no light was simulated [m].
    pub truth_m: Option<f64>,
    /// Distance from the truth beyond which a depth is an outlier [m].
    pub limit_m: f64,
}

impl Judge {
    /// Whether a depth is far off, negative or no number.
    pub fn is_outlier(&self, depth_m: f64) -> bool {
        is_outlier(depth_m, self.truth_m.unwrap_or(depth_m), self.limit_m)
    }

    /// Returns the error of a mean [m].
    pub fn error_m(&self, mean_m: f64) -> Option<f64> {
        Some(mean_m - self.truth_m?)
    }
}

/// Statistics of an estimator over the frames or pairs of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EstimatorStatistics {
    /// Its name on the command line.
    pub estimator: &'static str,
    /// Mean of its depths [m].
    pub mean_m: Option<f64>,
    /// Mean less the true distance [m].
    pub mean_error_m: Option<f64>,
    /// Two standard deviations of its depths, with n - 1 [m].
    pub two_sd_m: Option<f64>,
    /// Depths that are far off, negative or no number.
    pub outliers: u64,
    /// Frames or pairs without a depth.
    pub failures: u64,
}

/// The depths of an estimator so far.
#[derive(Clone, Debug, Default)]
struct Depths {
    estimator: &'static str,
    moments: Moments,
    outliers: u64,
    failures: u64,
}

/// The depths of all estimators so far.
#[derive(Clone, Debug, Default)]
pub struct Tally(Vec<Depths>);

impl Tally {
    /// Takes what the estimators say of the next frame or pair.
    pub fn add(&mut self, readings: &[Estimate], judge: &Judge) {
        if self.0.is_empty() {
            let empty =
                |reading: &Estimate| Depths { estimator: reading.estimator, ..Depths::default() };
            self.0 = readings.iter().map(empty).collect();
        }
        for (depths, reading) in self.0.iter_mut().zip(readings) {
            let Some(depth_m) = reading.depth_m else {
                depths.failures += 1;
                continue;
            };
            depths.outliers += u64::from(judge.is_outlier(depth_m));
            if depth_m.is_finite() {
                depths.moments.add(depth_m);
            }
        }
    }

    /// Returns the statistics of each estimator over two or more frames or pairs.
    pub fn statistics(&self, judge: &Judge) -> Vec<EstimatorStatistics> {
        let several = self.0.iter().filter(|depths| depths.moments.count + depths.failures > 1);
        let statistics = |depths: &Depths| EstimatorStatistics {
            estimator: depths.estimator,
            mean_m: depths.moments.mean(),
            mean_error_m: depths.moments.mean().and_then(|mean_m| judge.error_m(mean_m)),
            two_sd_m: depths.moments.two_sd(),
            outliers: depths.outliers,
            failures: depths.failures,
        };
        several.map(statistics).collect()
    }
}

/// Mean and squares of deviations of numbers as they come (Welford).
#[derive(Clone, Copy, Debug, Default)]
pub struct Moments {
    /// Number of values.
    pub count: u64,
    mean: f64,
    squares: f64,
}

impl Moments {
    /// Takes the next number.
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        let off = value - self.mean;
        self.mean += off / self.count as f64;
        self.squares += off * (value - self.mean);
    }

    /// Their mean, if there are any.
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then_some(self.mean)
    }

    /// Two standard deviations of them, with n - 1.
    pub fn two_sd(&self) -> Option<f64> {
        (self.count > 1).then(|| 2.0 * (self.squares / (self.count - 1) as f64).sqrt())
    }
}

/// Second opinions on the frames of a run, if there are any.
#[derive(Default)]
pub struct Opinions {
    second: Option<SecondOpinion>,
    disagreements: Disagreements,
    depths: Moments,
}

/// Statistics of second opinions over at least two frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OpinionStatistics {
    /// Its name on the command line.
    pub estimator: &'static str,
    /// Mean of the valid depths [m].
    pub mean_m: Option<f64>,
    /// Two standard deviations of them, with n - 1 [m].
    pub two_sd_m: Option<f64>,
    /// Mean less the true distance [m].
    pub mean_error_m: Option<f64>,
    /// Frames with a second opinion.
    pub frames: u64,
    /// Frames whose depth in the firmware differs from it by more than their spreads allow.
    #[serde(rename = "parted")]
    pub disagreeing: u64,
    /// Frames that it rejected.
    #[serde(rename = "unbelieved")]
    pub rejected: u64,
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
        self.disagreements.add(second, frame, opinion);
        opinion.depth_m.filter(|_| opinion.valid).into_iter().for_each(|m| self.depths.add(m));
    }

    /// Returns the notes on the second opinions.
    pub fn notes(&self) -> Vec<Note> {
        self.second.as_ref().map_or(Vec::new(), |second| self.disagreements.notes(second))
    }

    /// Returns the statistics of at least two second opinions.
    pub fn statistics(&self, judge: &Judge) -> Option<OpinionStatistics> {
        let Disagreements { frames, disagreeing, rejected, .. } = self.disagreements;
        let mean_m = self.depths.mean();
        (frames > 1).then(|| OpinionStatistics {
            estimator: ESTIMATOR,
            mean_m,
            two_sd_m: self.depths.two_sd(),
            mean_error_m: mean_m.and_then(|mean_m| judge.error_m(mean_m)),
            frames,
            disagreeing,
            rejected,
        })
    }
}

/// Returns who gives second opinions on a setup's histograms; a note says why nobody does, which is no matter for
/// `--strict`.
pub fn second_opinion(
    setup: &Setup,
    notes: &mut Vec<Note>,
    console: &Console,
) -> Option<SecondOpinion> {
    let why = match SecondOpinion::new(setup) {
        Ok(second) => return Some(second),
        Err(why) => why,
    };
    if !notes.contains(&why) {
        console.note(&why);
        notes.push(why);
    }
    None
}

/// An estimate of the only frame: depth, word, error, and what the estimator states beside them.
pub fn in_words(estimate: &Estimate, truth: Option<TrueDepths>) -> String {
    let error = |depth_m: f64, truth_m: Option<f64>| {
        let text = |truth_m| format!("  {} mm", signed(1e3 * (depth_m - truth_m), 2));
        truth_m.map_or(String::new(), text)
    };
    let mut text = estimate.depth_m.map_or("none".to_owned(), |m| format!("{m:.6} m"));
    text += &estimate.depth_raw.map_or(String::new(), |word| format!("  {}", digits(word)));
    if let Some(depth_m) = estimate.depth_m {
        text += &error(depth_m, truth.map(|truth| truth.first_m));
    }
    if let Some(sigma_m) = estimate.sigma_m {
        text += &format!("  {}, sd {sigma_m:.6} m", estimate.estimator);
    }
    if let Some(why) = estimate.rejection() {
        text += &format!(", rejected: {why}");
    }
    if let Some(second) = &estimate.second {
        text += &format!(", second target {:.6} m", second.depth_m);
        text += &error(second.depth_m, truth.and_then(|truth| truth.second_m));
        text += &format!(", sd {:.6} m", second.sigma_m);
        if let Some(status) = second.status.filter(|status| !status.is_empty()) {
            text += &format!(", rejected: {status}");
        }
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
        text += &format!(", error {} mm", signed(1e3 * error_m, 3));
    }
    if let Some(two_sd_m) = of.two_sd_m {
        text += &format!(", 2σ {two_sd_m:.6} m");
    }
    let [disagreeing, frames] = [of.disagreeing, of.frames].map(grouped);
    let rejected = counted(of.rejected, "frames");
    text + &format!("\n{disagreeing} of {frames} depths disagree with it; it rejected {rejected}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reading(depth_m: Option<f64>) -> Vec<Estimate> {
        vec![Estimate::of_depth("peak", depth_m)]
    }

    #[test]
    fn what_is_far_off_negative_or_missing_is_counted() {
        let judge = Judge { truth_m: Some(0.05), limit_m: 0.1 };
        let mut tally = Tally::default();
        assert!(tally.statistics(&judge).is_empty());
        for depth_m in [Some(0.04), Some(0.2), Some(-0.03), Some(f64::NAN), None] {
            tally.add(&reading(depth_m), &judge);
        }
        let [found] = &tally.statistics(&judge)[..] else { panic!("one estimator") };
        assert_eq!((found.outliers, found.failures), (3, 1));
        assert!((found.mean_m.unwrap() - 0.07).abs() < 1e-12, "{found:?}");
        assert!((found.mean_error_m.unwrap() - 0.02).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn without_a_truth_there_is_no_error_and_only_nonsense_is_an_outlier() {
        let judge = Judge { truth_m: None, limit_m: 0.1 };
        assert_eq!([5.0, -0.01, f64::NAN].map(|m| judge.is_outlier(m)), [false, true, true]);
        assert_eq!(judge.error_m(0.3), None);
    }

    #[test]
    fn moments_are_those_of_the_numbers() {
        let mut moments = Moments::default();
        assert_eq!((moments.mean(), moments.two_sd()), (None, None));
        [1.0, 2.0, 3.0, 4.0, 5.0].into_iter().for_each(|value| moments.add(value));
        assert_eq!(moments.mean(), Some(3.0));
        assert!((moments.two_sd().unwrap() - 2.0 * 2.5f64.sqrt()).abs() < 1e-12);
    }
}
