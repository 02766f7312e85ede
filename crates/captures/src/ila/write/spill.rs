//! Buffering of text before it is written. The block size affects how an archive is compressed.

use std::io::{self, Write};

/// Block size [bytes].
const BLOCK: usize = 1 << 16;

/// Writes the buffered text if it fills a block.
pub(super) fn spill(out: &mut dyn Write, text: &mut Vec<u8>) -> io::Result<()> {
    if text.len() >= BLOCK {
        out.write_all(text)?;
        text.clear();
    }
    Ok(())
}
