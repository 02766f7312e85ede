//! What a board saw, beside the simulation.
//!
//! A logic analyser in a run and Vivado's files ([`ila`]), any waveform as a stream of changes
//! ([`source`]), conditions over signals ([`condition`]), the comparison of two of them
//! ([`compare`]), and a run again from what a capture shows of it ([`replay`]).

pub mod compare;
pub mod condition;
pub mod ila;
pub mod replay;
pub mod source;
mod words;
