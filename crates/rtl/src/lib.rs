//! The firmware in Verilog, other people's too, beside the model.
//!
//! Golden vectors with self-checking benches ([`golden`]), and simulators, maps and proofs that hold
//! a design to them ([`verify`]); and how fast it can be clocked ([`timing`]).

pub mod block;
pub mod checkers;
pub mod golden;
pub mod instrument;
pub mod timing;
pub mod verify;
