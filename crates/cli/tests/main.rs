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
mod grid;
mod ila_command;
mod lockstep;
mod measured;
mod quantize;
mod subtraction;
mod synthesis;
mod three_ways;
mod train;
mod vectors;
mod verify;
mod waveform;
