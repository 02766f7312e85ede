//! From a histogram to a distance: the network and the estimators it is measured against.
//!
//! | name | what it does | source |
//! |---|---|---|
//! | `network` | the network in fixed point, bit for bit as the firmware | thesis ch. 6 |
//! | `network-float` | the same network in double precision | thesis 5.3 |
//! | `centroid` | highest bin, centroid around it, bit for bit as the firmware's other estimator | plain |
//! | `peak` | spline, one peak, straight line through the shift | Listings 5.1 to 5.3 |
//! | `subtraction` | the same on a lit histogram less a dark one | Algorithm 2 |
//! | `likelihood` | the most likely distance, with pile-up in the model | eq. 3.21 to 3.24 |
//! | `matched` | pile-up taken out, background out, correlation with the pulse | Coates 1968 |
//!
//! 2 sd of the distance [mm] at 0.1 .. 0.6 m, chain `ideal`, over the grid of thesis section 4.4
//! (`tests/estimators` repeats these in small):
//!
//! | | 0.1 | 0.2 | 0.3 | 0.4 | 0.5 | 0.6 | histograms |
//! |---|---|---|---|---|---|---|---|
//! | Cramér-Rao bound | 0.55 | 0.44 | 0.45 | 0.55 | 0.74 | 1.05 | |
//! | `likelihood` | 0.55 | 0.43 | 0.45 | 0.55 | 0.74 | 1.05 | 9,000 each |
//! | `matched` | 0.79 | 0.55 | 0.52 | 0.61 | 0.81 | 1.13 | 30,000 each |
//! | `peak`, successes | 11.0 | 12.4 | 10.5 | 10.2 | 9.9 | 9.7 | 30,000 each |
//! | `peak`, failures | 0 | 2 | 2 | 3 | 401 | 2510 | of 30,000 |
//!
//! The last three estimators know the edges of the bins, which are those of any carry chain; the last
//! two, and [`likelihood::Model::cramer_rao_m`], the pulse's shape as well.

pub mod by_name;
pub mod centroid;
pub mod coates;
pub mod findpeaks;
pub mod likelihood;
pub mod matched_filter;
pub mod network;
pub mod panel;
pub mod peak_detection;
pub mod spline;
pub mod subtraction;

use std::fmt;

use tofsim::network::Histogram;
use tofsim::optics::budget::LIGHT_M_S;

pub use by_name::{Kind, Needs};
pub use panel::{Panel, Reading};
pub use subtraction::Pair;

/// Width of a bin as the decoder's codes count it [ps].
pub const BIN_PS: f64 = 25.0;
/// Mean arrival of an echo for each metre of distance, 2 / c (eq. 3.23) [ps/m].
pub const ARRIVAL_PS_PER_M: f64 = 2e12 / LIGHT_M_S;

/// Finds the distance of a target from the histogram of a frame.
pub trait Estimator: Sync {
    /// Its name on the command line.
    fn name(&self) -> &'static str;

    /// Distance of the target [m].
    ///
    /// # Errors
    /// When the histogram does not show one.
    fn estimate(&self, histogram: &Histogram) -> Result<f64, Failure>;

    /// Whether it has to have a dark histogram too.
    fn needs_dark(&self) -> bool {
        false
    }

    /// Distance of the target, where the lit histogram has a dark one beside it: most have no use
    /// for that [m].
    ///
    /// # Errors
    /// When the histograms do not show one.
    fn estimate_pair(&self, pair: &Pair) -> Result<f64, Failure> {
        self.estimate(&pair.lit)
    }
}

/// Why there is no distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Failure {
    /// The histogram is empty.
    NoHits,
    /// It holds more hits than it can have [hits].
    TooManyHits {
        /// Sum over the bins.
        hits: u32,
        /// Largest sum that is possible.
        most: u32,
    },
    /// Nothing stands out of the background.
    NoPeak,
    /// So many peaks stand out, and nothing tells which is the echo.
    SeveralPeaks(usize),
    /// There is no dark histogram to subtract.
    NoDarkFrame,
    /// The iterations did not settle.
    NoConvergence,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::NoHits => write!(f, "no hits"),
            Failure::TooManyHits { hits, most } => {
                write!(f, "{hits} hits, expected {most} at most")
            }
            Failure::NoPeak => write!(f, "no peak"),
            Failure::SeveralPeaks(peaks) => write!(f, "{peaks} peaks"),
            Failure::NoDarkFrame => write!(f, "no dark frame"),
            Failure::NoConvergence => write!(f, "no convergence"),
        }
    }
}

impl std::error::Error for Failure {}

/// Sum of a histogram, which has to be 1 to `most` [hits].
fn hits(histogram: &Histogram, most: u32) -> Result<u32, Failure> {
    match histogram.iter().map(|&count| u32::from(count)).sum() {
        0 => Err(Failure::NoHits),
        hits if hits > most => Err(Failure::TooManyHits { hits, most }),
        hits => Ok(hits),
    }
}
