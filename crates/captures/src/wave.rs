//! A single waveform: its contents ([`Contents`]), what its signals do ([`statistics`]), and its conversion to other
//! formats ([`convert`]).

mod columns;
mod contents;
mod convert;
mod csv;
mod excerpt;
mod json;
mod pulses;
mod statistics;
mod values;

pub use contents::Contents;
pub use convert::{OutputFormat, convert};
pub use excerpt::Excerpt;
pub use pulses::Pulses;
pub use statistics::{SignalStatistics, statistics};
