//! Infrastructure of clocked designs: time, clocks, wrapping words, modules, named signals and their sizes.

mod bits;
pub mod clock;
mod clocked;
pub mod connect;
pub mod module;
pub mod pulse;
pub mod scan;
pub mod signals;
pub mod sizes;
mod tap_groups;
pub(crate) mod thermometer;
pub(crate) mod time;
pub mod verilog;
mod word_format;

pub use bits::{S, U};
pub use clocked::{ASLEEP, AWAKE, Clocked, asleep_if};
pub use tap_groups::{PartialOnes, ones_width, partial_highest, partial_ones};
pub use thermometer::Thermometer;
pub use time::Time;
pub use word_format::{Overflow, WordFormat, wrapped};
