//! Runs Verilog against the golden vectors, and reports where it differs.

pub mod process;
pub mod rtl;

pub use rtl::Rtl;
