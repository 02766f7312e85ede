//! The times of a section of an FST file.

use super::blocks::{long, number};

/// Compression level of zlib. Times are so repetitive that higher levels have no effect.
const ZLIB: u8 = 3;

/// Strictly increasing times.
#[derive(Default)]
pub(super) struct Times {
    /// First time, followed by the differences of consecutive times.
    pub(super) steps: Vec<u8>,
    /// Number of the last time, from 0.
    pub(super) last: u64,
}

impl Times {
    /// Adds the next time, given the previous one, in units of the file.
    pub(super) fn push(&mut self, at: u64, before: u64) {
        if self.steps.is_empty() {
            number(&mut self.steps, at);
        } else {
            self.last += 1;
            number(&mut self.steps, at - before);
        }
    }

    /// Appends the times to a section, compressed if that is shorter, and clears them.
    pub(super) fn take(&mut self, section: &mut Vec<u8>) {
        let packed = miniz_oxide::deflate::compress_to_vec_zlib(&self.steps, ZLIB);
        let shorter = if packed.len() < self.steps.len() { &packed } else { &self.steps };
        section.extend_from_slice(shorter);
        for count in [self.steps.len() as u64, shorter.len() as u64, self.last + 1] {
            long(section, count);
        }
        self.steps.clear();
        self.last = 0;
    }
}
