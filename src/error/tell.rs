//! Messages on standard error.

use std::fmt::Display;
use std::io::{Write, stderr};

/// Prints a message, a line. Nobody may be there to read it: a closed pipe or a full disk is not an error.
pub fn tell(message: impl Display) {
    let _ = stderr().write_all(format!("{message}\n").as_bytes());
}
