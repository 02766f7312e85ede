//! The scenario file: typed, checked, every number with unit, default and source.

#[doc(hidden)]
pub mod builtin;
#[doc(hidden)]
pub mod chain;
mod illuminance;
mod load;
mod model;
#[doc(hidden)]
pub mod show;
mod validate;
#[doc(hidden)]
pub mod window;

pub use load::{DEFAULT, Loaded, load};
pub use model::*;
