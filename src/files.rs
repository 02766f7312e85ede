//! File formats and output files: errors name a position in the input, and outputs are complete or absent.

pub mod csv;
pub mod csv_output;
pub mod date;
pub mod digest;
pub mod folder;
pub mod npy;
pub mod output;
pub mod staged;
pub mod toml;
pub mod unfinished;
