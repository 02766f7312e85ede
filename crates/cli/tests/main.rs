//! The command, as its users see it.

mod adding_a_block;
mod bad_input;
mod budget;
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
mod limits;
mod lockstep;
mod quantize;
mod rerun;
mod subtraction;
mod synthesis;
mod three_ways;
mod train;
mod vectors;
mod verify;
mod waveform;
