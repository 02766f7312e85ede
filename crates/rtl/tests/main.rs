//! Rust and Verilog, side by side.

mod board;
#[path = "../../../tests/common.rs"]
mod common;
mod mirror;
mod roms;
mod sizes;
