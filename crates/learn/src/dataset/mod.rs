//! Histograms in bulk: scenes on a grid, a histogram drawn for each.
//!
//! A [`Grid`] or a [`Subset`] of one says which scene each row has; a [`Source`] draws the row's
//! histogram as `run --fidelity histogram` draws a frame, in one step. A row has random numbers of
//! its own, found by seed and row number, so that any one can be made again without the others. [`files`]
//! writes them, as `tofsim dataset` does, and [`read`] reads them.

pub mod blocks;
pub mod description;
pub mod files;
pub mod grid;
pub mod npy;
mod npy_read;
pub mod pairs;
pub mod parquet_file;
mod parquet_read;
mod read;
pub mod rows;
pub mod source;
pub mod subset;

pub use blocks::{BLOCK, Blocks, Sample};
pub use description::Description;
pub use grid::{Grid, Steps};
pub use pairs::Pairs;
pub use read::read;
pub use rows::{Row, Rows};
pub use source::Source;
pub use subset::Subset;

/// What the sensor looks at; all else is the scenario's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    /// Distance of the target, what an estimator is to find (`target.distance_m`) [m].
    pub distance_m: f64,
    /// Reflectance of the target (`target.reflectance`) [1].
    pub reflectance: f64,
    /// Spectral irradiance of the target (`ambient.irradiance_w_m2_nm`) [W/m^2/nm].
    pub irradiance_w_m2_nm: f64,
}
