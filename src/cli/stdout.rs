//! Standard output, where data goes.

use std::io::{self, Write};
use std::path::Path;

use crate::error::{Error, Result};

/// Prints `text` as it is; a closed pipe or a full disk is an error.
pub fn print(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    written.map_err(Error::io(Path::new("stdout"), "write"))
}
