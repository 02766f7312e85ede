//! Tests of captures, as files and from a running simulation.

#[path = "../../../tests/common.rs"]
mod common;
mod fst;
mod fuzz;
mod ghw;
mod ila;
mod ila_archives;
mod ila_arrays;
mod ila_capture;
mod ila_files;
mod ila_round_trip;
mod ila_spreadsheets;
mod many_signals;
mod other_tools;
mod words;
