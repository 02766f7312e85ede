//! Rust and Verilog, side by side.

#[path = "../../../tests/common.rs"]
mod common;
mod mirror;
mod roms;
mod sizes;
