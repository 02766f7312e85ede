//! Runs Verilog, and VHDL as Verilog, against the golden vectors, and reports where it differs.

mod adapter;
pub mod check;
pub mod cycle_counts;
pub mod interface;
pub mod map;
pub mod observed;
pub mod process;
pub mod rtl;
pub mod simulator;
pub mod strays;
pub mod verdict;
mod vhdl;
mod wave;

pub use check::{BlockCheck, BlockReport};
pub use map::RtlMap;
pub use rtl::Rtl;
pub use simulator::Simulator;
pub use verdict::Verdict;
