//! From a histogram to a distance: the network and the estimators it is measured against.
//!
//! | name | what it does | source |
//! |---|---|---|
//! | `network` | the network in fixed point, bit for bit as the firmware | thesis ch. 6 |
//! | `network-float` | the same network in double precision | thesis 5.3 |
//! | `centroid` | highest bin, centroid around it, bit for bit as the firmware | plain |
//! | `peak` | spline, one peak, straight line through the shift | Listings 5.1 to 5.3 |
//! | `subtraction` | the same on a lit histogram less a dark one | Algorithm 2 |
//! | `likelihood` | the most likely distance, with pile-up in the model | eq. 3.21 to 3.24 |
//! | `two-echoes` | the same with a second echo, where one is sure | eq. 3.21 to 3.24 |
//! | `likelihood_estimator` | `likelihood` in integers, bit for bit as the firmware would | eq. 3.21 to 3.24 |
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
//! The last four estimators know the edges of the bins, which are those of any carry chain; the last
//! three, and [`likelihood::Model::cramer_rao_m`], the pulse's shape as well.

pub mod acquisition;
pub mod coates;
pub mod estimator;
pub mod findpeaks;
pub mod in_firmware;
pub mod likelihood;
pub mod matched_filter;
pub mod network;
pub mod notes;
pub mod panel;
pub mod peak_detection;
pub mod registry;
pub mod spline;
pub mod subtraction;

pub use acquisition::Acquisition;
pub use estimator::{EchoDepth, Estimate, Estimator, Failure, Found, HistogramPair, Pedestal};
pub use panel::Panel;
pub use registry::{EstimatorInputs, EstimatorKind, Needs};
