//! tofsim: a cycle-accurate simulator of the FPGA firmware of a time-of-flight rangefinder.

#![forbid(unsafe_code)]

pub mod error;
pub mod firmware;
pub mod kernel;
pub mod network;
pub mod optics;
pub mod output;
pub mod scenario;
pub mod waves;
