//! Waveform files of any design: VCD and FST.

pub mod signal;
pub(super) mod tables;
mod units;
pub(super) mod vcd;

pub use super::fst::dump::FstDump;
pub use signal::{
    Dump, DumpKind, DumpSignal, DumpState, DumpValue, SignalDescription, escaped, unescaped,
};
pub use units::{UNITS, unit};
pub use vcd::VcdDump;
