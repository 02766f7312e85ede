//! Waveform files of the firmware's signals: VCD and FST, and set-ups for their viewers.
//!
//! A waveform holds windows of the run; outside them every signal is `x`. Times are picoseconds,
//! rounded down. What a file contains follows from the hierarchy ([`crate::hierarchy`]):
//! ports that pass a signal on are aliases, written once.

mod body;
mod digits;
pub mod dump;
mod fst;
mod gtkwave;
mod layout;
pub(crate) mod marks;
mod scopes;
mod select;
pub mod side_by_side;
mod sources;
mod states;
mod surfer;
#[cfg(test)]
mod tests;
mod vcd;
mod views;
pub(crate) mod writer;

pub use digits::{Bits, TapDigits};
pub use gtkwave::zoom;
pub use marks::Marks;
pub use select::select;
pub use views::write_views;
pub use writer::{WaveFormat, Waves};
