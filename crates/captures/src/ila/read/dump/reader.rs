//! The lines of a dump: a key, a colon, and text, numbers or samples.

use std::fmt::Display;
use std::io::{BufRead, Read};

use tofsim::error::{Error, Input, Result};

use super::super::opened::damaged;

/// Longest key [bytes].
const LONGEST_KEY: u64 = 64;
/// Longest line of numbers [bytes].
const LONGEST_LIST: u64 = 1 << 21;

/// A dump being read.
pub(super) struct Reader<'a, R> {
    pub(super) source: &'a str,
    file: R,
    /// Line, from 1.
    line: usize,
}

impl<'a, R: BufRead> Reader<'a, R> {
    pub(super) fn new(source: &'a str, file: R) -> Self {
        Reader { source, file, line: 0 }
    }

    pub(super) fn fault(&self, column: usize, expected: impl Display) -> Input {
        Input::new(self.source, expected).at(self.line, column)
    }

    /// What stands before the colon of the next line that is not empty.
    pub(super) fn key(&mut self) -> Result<Option<String>> {
        loop {
            self.line += 1;
            let mut key = Vec::new();
            loop {
                let mut byte = [0];
                let count =
                    self.file.read(&mut byte).map_err(|error| damaged(self.source, error))?;
                match byte[0] {
                    b':' if count > 0 => {
                        return Ok(Some(String::from_utf8_lossy(&key).trim().to_owned()));
                    }
                    b'\n' if count > 0 => break,
                    byte if count > 0 && (key.len() as u64) < LONGEST_KEY => key.push(byte),
                    _ if key.trim_ascii().is_empty() && count == 0 => return Ok(None),
                    _ => break,
                }
            }
            if !key.trim_ascii().is_empty() {
                let value = String::from_utf8_lossy(&key).into_owned();
                return Err(self
                    .fault(1, "expected a key, a colon and a value")
                    .value(value)
                    .into());
            }
        }
    }

    pub(super) fn text(&mut self, column: usize) -> Result<String> {
        let mut text = Vec::new();
        let mut line = self.file.by_ref().take(LONGEST_LIST);
        let count =
            line.read_until(b'\n', &mut text).map_err(|error| damaged(self.source, error))?;
        if count as u64 == LONGEST_LIST && text.last() != Some(&b'\n') {
            let text = format!("the line is longer than {LONGEST_LIST} bytes");
            return Err(self.fault(column, text).into());
        }
        Ok(String::from_utf8_lossy(&text).trim().to_owned())
    }

    pub(super) fn list(&mut self, key: &str, column: usize) -> Result<Vec<u64>> {
        let text = self.text(column)?;
        let number = |word: &str| {
            let fault = self.fault(column, "expected numbers of samples").field(key).value(word);
            word.parse().map_err(|_| Error::from(fault))
        };
        text.split_ascii_whitespace().map(number).collect()
    }

    pub(super) fn number(&mut self, key: &str, column: usize) -> Result<u64> {
        let text = self.text(column)?;
        let fault = || self.fault(column, "expected a whole number").field(key).value(&text);
        Ok(text.parse().map_err(|_| fault())?)
    }

    pub(super) fn skip(&mut self) -> Result<()> {
        self.file.skip_until(b'\n').map_err(|error| damaged(self.source, error))?;
        Ok(())
    }

    /// Packs the samples of a bit.
    pub(super) fn channel(&mut self, key: &str, samples: u64, bits: &mut Vec<u64>) -> Result<()> {
        let (mut count, mut word, mut column) = (0, 0, key.len() + 1);
        let mut ended = false;
        while !ended {
            let buffer = match self.file.fill_buf() {
                Ok(buffer) => buffer,
                Err(error) => return Err(damaged(self.source, error)),
            };
            let mut used = 0;
            let mut wrong = None;
            for &byte in buffer {
                (used, column) = (used + 1, column + 1);
                match byte {
                    b'0' | b'1' if count < samples => {
                        word |= ((byte & 1) as u64) << (count % 64);
                        count += 1;
                        if count.is_multiple_of(64) {
                            bits.push(word);
                            word = 0;
                        }
                    }
                    b'\n' => {
                        ended = true;
                        break;
                    }
                    b' ' if count == 0 => {}
                    b'\r' => {}
                    _ => {
                        wrong = Some(byte);
                        break;
                    }
                }
            }
            ended |= buffer.is_empty();
            self.file.consume(used);
            if let Some(byte) = wrong {
                let expected = match byte {
                    b'0' | b'1' => {
                        format!("expected no more than {samples} samples (sample_count)")
                    }
                    _ => "expected 0 or 1".to_owned(),
                };
                let fault = self.fault(column, expected).field(key);
                return Err(fault.value(byte as char).into());
            }
        }
        if count != samples {
            let text = format!("{count} samples, expected {samples} (sample_count)");
            return Err(self.fault(column, text).field(key).into());
        }
        if !count.is_multiple_of(64) {
            bits.push(word);
        }
        Ok(())
    }
}
