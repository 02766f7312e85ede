//! Rust and Verilog, side by side.

mod board;
#[path = "../../../tests/common.rs"]
mod common;
mod mirror;
#[path = "../../../tests/record.rs"]
mod record;
mod records;
mod roms;
mod sizes;
