//! Standard output, where data goes.

use std::io::{self, BufWriter, StdoutLock, Write};
use std::path::Path;

use serde_json::Value;

use tofsim::error::{Error, Result};

/// Prints `text` as it is; a closed pipe or a full disk is an error.
pub fn print(text: &str) -> Result<()> {
    print_with(|out| out.write_all(text.as_bytes()))
}

/// Prints an object as a line of JSON.
pub fn print_json(object: &Value) -> Result<()> {
    print(&format!("{object}\n"))
}

/// Prints what `fill` writes; a closed pipe or a full disk is an error.
pub fn print_with(fill: impl FnOnce(&mut BufWriter<StdoutLock>) -> io::Result<()>) -> Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    let written = fill(&mut out).and_then(|()| out.flush());
    written.map_err(Error::io(Path::new("stdout"), "write"))
}
