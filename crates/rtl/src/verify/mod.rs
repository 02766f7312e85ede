//! Runs Verilog against the golden vectors, and reports where it differs.

mod adapter;
pub mod check;
pub mod cycle_counts;
pub mod interface;
pub mod map;
pub mod process;
pub mod rtl;
pub mod seen;
pub mod simulator;
pub mod verdict;
mod wave;

pub use check::{Check, Report};
pub use map::Map;
pub use rtl::Rtl;
pub use simulator::Simulator;
pub use verdict::Verdict;

/// The estimator that the thesis does not have, and other people's designs need not.
pub const CENTROID: &str = "centroid_estimator";
