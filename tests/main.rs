//! The simulator, as those see it who build on it.

mod any_input;
mod common;
mod conditions;
mod depth;
mod docs;
mod effects;
mod ends_of_range;
mod fast_ways;
mod histogram_file;
mod layers;
mod leap;
mod physics;
mod public_face;
mod scene;
mod spad;
mod spad_row;
mod stepping;
mod typed_datapath;
mod whole_chain;
