//! The command, as its users see it.

mod adding_a_block;
mod bad_input;
mod centroid;
mod cli;
mod commands;
mod common;
mod compare;
mod control;
mod dataset;
mod estimate;
mod evaluate;
mod fidelities;
mod golden;
mod ila_command;
mod lockstep;
mod quantize;
mod subtraction;
mod synthesis;
mod terminal;
mod three_ways;
mod train;
mod vectors;
mod verify;
mod waveform;
