//! Golden vectors: what each block does, clock by clock, for anyone's Verilog.
//!
//! A [`Spec`] says what a block is beside its ports; its `record` steps the Rust model of it with
//! random and directed input and gives [`Vectors`], which [`Vectors::write`] turns into files with a
//! self-checking bench.

pub mod bench;
pub mod blocks;
pub mod cover;
pub mod draw;
mod estimations;
mod lines;
pub mod parameters;
pub mod ports;
mod prelude;
mod record;
pub mod roms;
pub mod setting;
pub mod spec;
pub mod stops;
pub mod table;
pub mod timing;
mod top;
mod vectors;
pub mod verilog;

pub use blocks::BLOCKS;
pub use setting::Setting;
pub use spec::{Spec, Vectors};
