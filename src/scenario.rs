//! The scenario file: typed, checked, every number with unit, default and source.

#[doc(hidden)]
pub mod builtin;
#[doc(hidden)]
pub mod bundle;
#[doc(hidden)]
pub mod calibration;
#[doc(hidden)]
pub mod chain;
pub mod chains;
#[doc(hidden)]
pub mod cover_fractions;
#[doc(hidden)]
pub mod dark;
#[doc(hidden)]
pub mod drift;
#[doc(hidden)]
pub mod effects;
pub mod glass;
mod illuminance;
#[doc(hidden)]
pub mod keys;
mod load;
#[doc(hidden)]
pub mod mesh;
mod model;
#[doc(hidden)]
pub mod offsets;
mod pixel_values;
#[doc(hidden)]
pub mod projection;
#[doc(hidden)]
pub mod pulse;
#[doc(hidden)]
pub mod show;
mod validate;
#[doc(hidden)]
pub mod window;
#[doc(hidden)]
pub mod wiring;

/// Greatest seed: the greatest integer of TOML, so that a scenario can have every seed that a command can.
pub const MOST_SEED: u64 = i64::MAX as u64;

pub use load::{DEFAULT, Loaded, from_text, load};
pub use model::*;
