//! The scenario file: typed, checked, every number with unit, default and source.

pub mod builtin;
pub mod chain;
mod load;
mod model;
pub mod show;
mod validate;
pub mod window;

pub use load::{DEFAULT, Loaded, load};
pub use model::*;
