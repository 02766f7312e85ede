//! Captures of the board, in relation to the simulation.
//!
//! The crate has a logic analyser for simulations and Vivado's file formats ([`ila`]), waveforms as streams of
//! changes ([`source`]), conditions over signals ([`condition`]), the comparison of two waveforms ([`compare`]),
//! the inspection and conversion of one ([`wave`]), and the replay of a capture's inputs ([`replay`]).

#![allow(clippy::disallowed_methods, reason = "captures are looked at before they are opened")]

pub mod choice;
pub mod compare;
pub mod condition;
pub mod ila;
pub mod replay;
pub mod source;
pub mod wave;
mod words;
