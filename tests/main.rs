//! The simulator, as those see it who build on it.

mod any_input;
mod common;
mod depth;
mod docs;
mod gaits;
mod histogram_file;
mod layers;
mod leap;
mod physics;
mod skip;
mod whole_chain;
