//! Text is gathered before it goes to the file. How an archive is packed hangs on it.

use std::io::{self, Write};

/// Bytes gathered.
const BLOCK: usize = 1 << 16;

/// Writes what was gathered, if it is worth it.
pub(super) fn spill(out: &mut dyn Write, text: &mut Vec<u8>) -> io::Result<()> {
    if text.len() >= BLOCK {
        out.write_all(text)?;
        text.clear();
    }
    Ok(())
}
