//! tofsim within a test bench: model blocks that run in parallel with the design's, and photons for the design,
//! behind C functions that SystemVerilog imports.
//!
//! `border` contains the exported functions; the rest is plain Rust. A handle is a number that is looked up, so that
//! a null, stale or foreign one is merely an error, and panics do not cross the boundary.

mod arguments;
mod border;
mod checker;
mod objects;
mod photons;

pub use border::*;
