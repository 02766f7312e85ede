//! The scenario file: typed, checked, every number with unit, default and source.

mod model;

pub use model::*;
