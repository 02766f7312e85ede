//! The times of a section of an FST file.

use super::blocks::{long, number};

/// Level of zlib: times repeat so much that more brings nothing.
const ZLIB: u8 = 3;

/// Times, each later than the one before it.
#[derive(Default)]
pub(super) struct Times {
    /// The first one, then each as what it is more than the one before it.
    pub(super) steps: Vec<u8>,
    /// Number of the last one, from 0.
    pub(super) last: u64,
}

impl Times {
    /// Takes the next time, which comes after `before` [ps].
    pub(super) fn push(&mut self, at: u64, before: u64) {
        if self.steps.is_empty() {
            number(&mut self.steps, at);
        } else {
            self.last += 1;
            number(&mut self.steps, at - before);
        }
    }

    /// Appends them, compressed if that makes them shorter, and begins anew.
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
