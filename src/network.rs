//! The depth network: its file, its passes in fixed and floating point, and its ROMs.

pub mod domain;
pub mod estimate;
pub mod file;
pub mod float;
pub mod histogram;
pub mod histogram_csv;
pub mod histogram_file;
pub mod mem;
pub mod pass;
pub mod roms;
mod round;
mod schema;
pub mod unrounded;
mod weights;
mod write;

pub use domain::Domain;
pub use estimate::{Estimate, estimate};
pub use file::Network;
pub use histogram::Histogram;
pub use weights::{Fixed, Weights};
