//! A file that is read a byte at a time without a call for each.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Result, Seek, SeekFrom};

/// Bytes that are read at once.
const CHUNK: usize = 1 << 17;

/// A file whose single bytes come from a buffer, inlined where they are read: the waveform library
/// asks for each byte of a VCD on its own.
pub(super) struct Bytes(BufReader<File>);

impl Bytes {
    pub(super) fn new(file: File) -> Bytes {
        Bytes(BufReader::with_capacity(CHUNK, file))
    }
}

impl Read for Bytes {
    #[inline(always)]
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        if let [into] = into
            && let [byte, ..] = self.0.buffer()
        {
            *into = *byte;
            self.0.consume(1);
            return Ok(1);
        }
        self.0.read(into)
    }
}

impl BufRead for Bytes {
    fn fill_buf(&mut self) -> Result<&[u8]> {
        self.0.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.0.consume(count);
    }
}

impl Seek for Bytes {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        self.0.seek(to)
    }
}
