//! tofsim: a cycle-accurate simulator of the FPGA firmware of a time-of-flight rangefinder.
//!
//! Light by a link budget ([`optics`]) sets off avalanches in a detector ([`sensor`]); the firmware
//! ([`firmware`]), register by register as its Verilog has it, turns them into a histogram and the
//! histogram into metres, with the weights of a trained [`network`]. A [`sim::Run`] steps them
//! together, and [`waves`] writes what the signals do.

#![forbid(unsafe_code)]

pub mod cli;
pub mod compare;
pub mod condition;
pub mod csv_input;
pub mod dataset;
pub mod error;
pub mod estimation;
pub mod evaluation;
pub mod firmware;
pub mod golden;
pub mod hierarchy;
pub mod histogram_file;
pub mod ila;
pub mod kernel;
pub mod network;
mod npy_input;
pub mod optics;
pub mod output;
pub mod report;
pub mod scenario;
pub mod sensor;
pub mod sim;
pub mod source;
pub mod training;
pub mod verify;
pub mod waves;
