//! tofsim: a cycle-accurate simulator of the FPGA firmware of a time-of-flight rangefinder.
//!
//! Light by a link budget ([`optics`]) sets off avalanches in a detector ([`sensor`]); the firmware
//! ([`firmware`]), register by register as its Verilog has it, turns them into a histogram and the
//! histogram into metres, with the weights of a trained [`network`]. A [`sim::Run`] steps them
//! together, and [`waves`] writes what the signals do.

#![forbid(unsafe_code)]

pub mod error;
pub mod files;
pub mod firmware;
pub mod hierarchy;
pub mod kernel;
pub mod network;
pub mod optics;
pub mod scenario;
pub mod sensor;
pub mod sim;
pub mod waves;
