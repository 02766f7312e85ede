//! Files of every kind: read with errors that name the place, written whole or not at all.

pub mod csv;
pub mod date;
pub mod digest;
pub mod folder;
pub mod npy;
pub mod output;
pub mod staged;
pub mod toml;
pub mod unfinished;
