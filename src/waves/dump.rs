//! Waveform files of any design: VCD and FST.

pub mod signal;
pub(super) mod vcd;

pub use super::fst::dump::FstDump;
pub use signal::{Dump, DumpKind, DumpSignal, DumpValue, escaped, unescaped};
pub use vcd::VcdDump;
