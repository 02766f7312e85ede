//! Golden vectors: what each block does, clock by clock, for anyone's Verilog.
//!
//! A [`Spec`] says what a block is beside its ports; its `record` steps the Rust model of it with
//! random and directed input and gives [`Vectors`], which a self-checking [`Bench`](bench::Bench) writes
//! into files beside itself.

pub mod bench;
pub mod blocks;
pub mod configuration;
pub mod cover;
pub mod draw;
mod estimations;
pub mod glue;
pub(crate) mod inputs;
mod likelihood;
mod lines;
pub mod model;
pub mod parameters;
pub mod ports;
mod prelude;
mod record;
pub mod setting;
pub mod spec;
pub mod stops;
pub mod table;
pub mod timing;
pub(crate) mod top;
pub mod verilog;

pub use blocks::BLOCKS;
pub use configuration::Configuration;
pub use setting::Setting;
pub use spec::{Spec, Vectors};
