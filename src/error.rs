//! Errors with their position in an input, and the opening of inputs.

mod fault;
mod number;
pub mod open;
mod stop;
mod tell;

pub use fault::{Error, Input, Result, hint, line_and_column, nearest, shortened};
pub use number::short_number;
pub use open::{read_bytes, read_text};
pub use stop::poll_stop;
pub use tell::tell;
