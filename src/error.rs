//! Errors with their position in an input, and the opening of inputs.

mod fault;
pub mod open;

pub use fault::{Error, Input, Result, hint, line_and_column, nearest, shortened};
pub use open::{read_bytes, read_text};
