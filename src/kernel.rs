//! What any clocked design needs: time, clocks, words that wrap, modules, and named signals.

pub mod bits;
pub mod clock;
pub mod clocked;
pub mod connect;
pub mod module;
pub mod signals;
pub mod thermometer;
pub mod time;

pub use bits::{S, U};
pub use clocked::{ASLEEP, AWAKE, Clocked, asleep_if};
pub use thermometer::Thermometer;
pub use time::Time;
