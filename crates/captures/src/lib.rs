//! What a board saw, beside the simulation.
//!
//! A logic analyser in a run and Vivado's files ([`ila`]), any waveform as a stream of changes
//! ([`source`]), conditions over signals ([`condition`]), and the comparison of two of them
//! ([`compare`]).

pub mod compare;
pub mod condition;
pub mod ila;
pub mod source;
mod words;
