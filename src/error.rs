//! What can go wrong, and where; and how what users name is opened, which goes wrong most.

mod fault;
pub mod open;

pub use fault::{Error, Input, Result, hint, line_and_column, nearest, shortened};
pub use open::{read_bytes, read_text};
