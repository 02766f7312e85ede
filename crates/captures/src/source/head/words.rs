//! Words of a VCD, with their lines.

use std::io::{BufRead, Result as IoResult};

/// Words of a text, separated by blanks and line ends.
pub(crate) struct HeadWords<R> {
    file: R,
    /// Line of the last word, from 1.
    pub(crate) line: usize,
    /// Line of the next byte.
    next_line: usize,
    /// Number of bytes read.
    pub(super) place: u64,
}

impl<R: BufRead> HeadWords<R> {
    pub(crate) fn new(file: R) -> HeadWords<R> {
        HeadWords { file, line: 1, next_line: 1, place: 0 }
    }

    /// Reads a word and the byte behind it; `None` at the end.
    pub(crate) fn next(&mut self) -> IoResult<Option<Vec<u8>>> {
        let mut word = Vec::new();
        loop {
            let block = self.file.fill_buf()?;
            if block.is_empty() {
                return Ok(Some(word).filter(|word| !word.is_empty()));
            }
            let is_inside = |byte: &u8| !word.is_empty() || !byte.is_ascii_whitespace();
            let begin = block.iter().position(is_inside).unwrap_or(block.len());
            let (before, rest) = block.split_at(begin);
            let end = rest.iter().position(u8::is_ascii_whitespace);
            let part = &rest[..end.unwrap_or(rest.len())];
            let behind = &rest[part.len()..][..usize::from(end.is_some())];
            self.next_line += lines(before);
            if !part.is_empty() {
                self.line = self.next_line;
            }
            self.next_line += lines(behind);
            word.extend_from_slice(part);
            let count = before.len() + part.len() + behind.len();
            self.place += count as u64;
            self.file.consume(count);
            if end.is_some() {
                return Ok(Some(word));
            }
        }
    }
}

/// Counts the line ends in a text.
fn lines(text: &[u8]) -> usize {
    text.iter().filter(|&&byte| byte == b'\n').count()
}
