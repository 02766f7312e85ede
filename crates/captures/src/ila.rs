//! The logic analyser: captures signals of a simulation as Vivado's ILA does on the board, and reads and writes
//! Vivado's file formats.

pub mod builtin;
pub mod capture;
pub mod clock;
pub mod core;
pub mod debug_core;
pub mod export;
pub mod plan;
mod probe_values;
pub mod probes;
pub mod read;
pub mod sampler;
pub mod setup;
pub mod write;

pub use capture::{Capture, Probe, Radix};
pub use plan::AnalyserPlan;
pub use sampler::array::capture_array;
pub use sampler::{Analyser, capture, capture_live};
pub use setup::AnalyserSetup;
