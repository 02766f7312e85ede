//! Runs Verilog, and VHDL as Verilog, against the golden vectors, and reports where it differs.

mod adapter;
mod candidate;
pub mod check;
pub mod cycle_counts;
mod data;
pub mod interface;
mod latency;
pub mod map;
pub mod observed;
pub mod process;
pub mod report;
pub mod rtl;
pub mod simulator;
pub mod strays;
pub mod task;
mod tie;
pub mod verdict;
mod vhdl;
mod wave;
pub mod yosys;

pub use candidate::Dut;
pub use check::BlockCheck;
pub use map::RtlMap;
pub use report::BlockReport;
pub use rtl::Rtl;
pub use simulator::Simulator;
pub use task::Task;
pub use verdict::Verdict;
