//! Interface of estimators: the distance of a target from a histogram, or the reason for a failure.

use tofsim::firmware::likelihood_estimator::targets::Targets;
use tofsim::firmware::tof_top::status::{Status, StatusSet};
use tofsim::network::Histogram;

pub use tofsim::sim::estimates::{EchoDepth, Estimate, Pedestal};

/// A dark and a lit histogram of equally many shots.
#[derive(Clone, Debug, PartialEq)]
pub struct HistogramPair {
    /// H1, with the laser off [hits].
    pub dark: Histogram,
    /// H2, with the laser on [hits].
    pub lit: Histogram,
}

impl HistogramPair {
    /// H0 = H2 - H1, bin by bin [hits].
    pub fn difference(&self) -> Vec<i32> {
        self.lit.iter().zip(&self.dark).map(|(&lit, &dark)| lit as i32 - dark as i32).collect()
    }
}

/// How an estimator reports a second target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SecondTarget {
    /// Name of its distances in results.
    pub name: &'static str,
    /// Which of two targets comes first.
    pub targets: Targets,
}

/// Finds the distance of a target from the histogram of a frame.
pub trait Estimator: Send + Sync {
    /// Its name on the command line.
    fn name(&self) -> &'static str;

    /// Distance of the target [m].
    ///
    /// # Errors
    /// When the histogram does not show one.
    fn estimate(&self, histogram: &[u32]) -> Result<f64, Failure>;

    /// That distance, with all else that the estimator knows.
    ///
    /// # Errors
    /// When the histogram does not show one.
    fn find(&self, histogram: &[u32]) -> Result<Found, Failure> {
        self.estimate(histogram).map(Found::depth)
    }

    /// Returns how it reports a second target, if it looks for one.
    fn second(&self) -> Option<SecondTarget> {
        None
    }

    /// Returns whether the estimator requires a dark histogram too.
    fn needs_dark(&self) -> bool {
        false
    }

    /// Distance of the target, where the lit histogram has a dark one beside it: most have no use
    /// for that [m].
    ///
    /// # Errors
    /// When the histograms do not show one.
    fn estimate_pair(&self, pair: &HistogramPair) -> Result<f64, Failure> {
        self.estimate(&pair.lit)
    }
}

/// An estimator that is a function of the histogram, under a name of the command line.
pub struct FromFn<F> {
    /// Its name.
    pub name: &'static str,
    /// The function, which gives metres.
    pub estimate: F,
}

impl<F: Fn(&[u32]) -> Result<f64, Failure> + Send + Sync> Estimator for FromFn<F> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn estimate(&self, histogram: &[u32]) -> Result<f64, Failure> {
        (self.estimate)(histogram)
    }
}

/// Result of an estimator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Distance of the target, the first one if there are two [m].
    pub depth_m: f64,
    /// Its standard deviation, from an estimator that states one [m].
    pub sigma_m: Option<f64>,
    /// The second echo, where the estimator looks for one and is sure of it.
    pub second: Option<EchoDepth>,
    /// The cover window's light, from an estimator that has a template of it.
    pub pedestal: Option<Pedestal>,
}

impl Found {
    /// A depth, of which nothing else is known.
    pub fn depth(depth_m: f64) -> Self {
        Found { depth_m, sigma_m: None, second: None, pedestal: None }
    }

    /// The result of an estimator in the form of all estimates.
    pub fn estimate(estimator: &'static str, found: Result<Self, Failure>) -> Estimate {
        match found {
            Ok(Found { depth_m, sigma_m, second, pedestal }) => {
                let depth = Estimate::of_depth(estimator, Some(depth_m));
                Estimate { sigma_m, second, pedestal, ..depth }
            }
            Err(failure) => Estimate {
                status: failure.status(),
                failure: Some(failure.to_string()),
                ..Estimate::of_depth(estimator, None)
            },
        }
    }
}

/// Why there is no distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, thiserror::Error)]
pub enum Failure {
    /// The histogram is empty.
    #[error("no hits")]
    NoHits,
    /// The histogram contains more hits than is possible [hits].
    #[error("{hits} hits, expected {most} at most")]
    TooManyHits {
        /// Sum over the bins.
        hits: u32,
        /// Largest sum that is possible.
        most: u32,
    },
    /// Nothing stands out of the background.
    #[error("no peak")]
    NoPeak,
    /// So many peaks stand out, and nothing tells which is the echo.
    #[error("{0} peaks")]
    SeveralPeaks(usize),
    /// There is no dark histogram to subtract.
    #[error("no dark frame")]
    NoDarkFrame,
    /// The iterations did not settle.
    #[error("no convergence")]
    NoConvergence,
    /// The estimator rejects its depth.
    #[error("{0}")]
    Rejected(StatusSet),
}

impl Failure {
    /// The failure as the status of an estimate.
    pub fn status(self) -> StatusSet {
        let status = match self {
            Failure::NoHits => Status::NoHits,
            Failure::TooManyHits { .. } => Status::TooManyHits,
            Failure::NoPeak => Status::NoPeak,
            Failure::SeveralPeaks(_) => Status::SeveralPeaks,
            Failure::NoDarkFrame => Status::NoDarkFrame,
            Failure::NoConvergence => Status::NoConvergence,
            Failure::Rejected(status) => return status,
        };
        status.into()
    }
}

/// Sum of a histogram, which has to be 1 to `most` [hits].
pub(super) fn hits(histogram: &[u32], most: u32) -> Result<u32, Failure> {
    match histogram.iter().sum() {
        0 => Err(Failure::NoHits),
        hits if hits > most => Err(Failure::TooManyHits { hits, most }),
        hits => Ok(hits),
    }
}
