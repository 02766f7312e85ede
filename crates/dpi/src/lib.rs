//! tofsim inside somebody else's bench: blocks of the model beside theirs, and photons for their design, behind
//! functions of C that SystemVerilog imports.
//!
//! `border` holds what is called from outside; all else is plain Rust. A handle is a number that is looked up, so
//! that a null, stale or foreign one is an error with a name and nothing worse, and no panic gets out.

mod border;
mod checker;
mod held;
mod photons;
mod told;

pub use border::*;
