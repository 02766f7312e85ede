//! Training of the depth network (thesis chapter 5): Levenberg and Marquardt's method on simulated
//! histograms, from many starts, within the firmware's number formats.
//!
//! The same seed and recipe give the same network on every processor and for any number of threads:
//! sums are over fixed blocks, in order, without fused operations.

pub mod accuracy;
pub mod basis;
pub mod checkpoint;
pub mod cholesky;
pub mod data;
pub mod equalise;
pub mod features;
pub mod fold;
pub mod gram;
pub mod limits;
pub mod lm;
pub mod measured;
pub mod network_problem;
pub mod recipe;
pub mod start;
pub mod state;
pub mod sums;
pub mod tournament;
pub mod weighting;
