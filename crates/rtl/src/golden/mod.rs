//! Golden vectors: what each block does, clock by clock, for anyone's Verilog.
//!
//! A [`Spec`] says what a block is beside its ports; [`record`](Spec::record) steps the Rust model
//! of it with random and directed input and gives [`Vectors`], which [`vectors::write`] turns into
//! files with a self-checking bench.

pub mod bench;
pub mod block;
pub mod blocks;
pub mod cover;
pub mod draw;
pub mod ports;
mod record;
pub mod roms;
pub mod stops;
pub mod table;
pub mod timing;
mod top;
pub mod vectors;

pub use block::{Setting, Spec};
pub use blocks::BLOCKS;
pub use vectors::Vectors;
