//! Runs Verilog against the golden vectors, and reports where it differs.

mod adapter;
pub mod check;
pub mod cycle_counts;
mod data;
pub mod interface;
pub mod map;
pub mod observed;
pub mod process;
pub mod rtl;
pub mod simulator;
pub mod strays;
pub mod task;
pub mod verdict;
mod wave;

pub use check::{BlockCheck, BlockReport};
pub use map::RtlMap;
pub use rtl::Rtl;
pub use simulator::Simulator;
pub use task::Task;
pub use verdict::Verdict;
