//! The firmware in Verilog, other people's too, beside the model.
//!
//! Golden vectors with self-checking benches ([`golden`]), and simulators, maps and proofs that hold
//! a design to them ([`verify`]).

pub mod golden;
pub mod verify;
