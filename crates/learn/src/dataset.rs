//! Histograms in bulk: scenes on a grid, a histogram drawn for each.
//!
//! A [`Grid`] or a [`Subset`] of one says which scene each row has; a [`HistogramSource`] draws the row's
//! histogram as `run --fidelity histogram` draws a frame, in one step. A row has random numbers of
//! its own, found by seed and row number, so that any one can be made again without the others. [`files`]
//! writes them, as `tofsim dataset` does. [`Labelled`] reads those of one's own, measured or drawn.

pub mod axis;
pub mod blocks;
mod decimal;
pub mod description;
pub mod files;
mod format;
pub mod ftr;
pub mod grid;
pub mod grid_array;
pub mod grid_option;
mod label;
pub mod labelled;
pub mod npy;
pub mod pairs;
mod parquet_checksum;
mod parquet_columns;
mod parquet_file;
pub mod parquet_input;
mod parquet_pages;
pub mod parquet_table;
mod pixel_places;
pub mod rows;
pub mod scene_columns;
pub mod sensor;
pub mod shot_file;
pub mod source;
mod transaction_columns;
pub mod transaction_file;

pub use axis::Axis;
pub use blocks::{BLOCK, Sample};
pub use description::DatasetDescription;
pub use grid::{Grid, GridPurpose, Scene};
pub use grid_array::GridArray;
pub use grid_option::GridOption;
pub use label::Label;
pub use labelled::Labelled;
pub use pairs::Pairs;
pub use rows::{Rows, Subset};
pub use source::HistogramSource;
