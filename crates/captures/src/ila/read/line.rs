//! Lines of a dump: a key, a colon, and a text, numbers or samples.

use std::fmt::Display;

use tofsim::error::{Error, Input, Result};

/// Longest key [bytes].
const LONGEST_KEY: usize = 64;

/// Title in the banner.
const BANNER: &[u8] = b"ILA Data Dump";

/// Returns whether a line is empty or belongs to the banner.
fn is_banner(line: &[u8]) -> bool {
    line == BANNER || line.iter().all(|&byte| byte == b'=')
}

/// A non-empty line.
pub(super) struct Line<'a> {
    source: &'a str,
    number: usize,
    pub(super) key: String,
    /// Full text, including the line feed.
    text: &'a [u8],
    /// Offset of the value [bytes].
    begin: usize,
}

impl<'a> Line<'a> {
    /// Parses a line, including its line feed; returns `None` if it is empty or belongs to the banner.
    pub(super) fn new(source: &'a str, number: usize, text: &'a [u8]) -> Result<Option<Self>> {
        let colon = text.iter().take(LONGEST_KEY + 1).position(|&byte| byte == b':');
        let end = colon.unwrap_or(text.len().min(LONGEST_KEY));
        let key = String::from_utf8_lossy(&text[..end]).trim().to_owned();
        match colon {
            Some(colon) => Ok(Some(Line { source, number, key, text, begin: colon + 1 })),
            None if is_banner(text.trim_ascii()) => Ok(None),
            None => {
                let fault = Input::new(source, "expected a key, a colon and a value");
                Err(fault.at(number, 1).value(key).into())
            }
        }
    }

    /// Creates an error at a column.
    pub(super) fn fault(&self, column: usize, expected: impl Display) -> Input {
        Input::new(self.source, expected).at(self.number, column).field(&self.key)
    }

    /// Returns the text after the colon.
    pub(super) fn value(&self) -> String {
        String::from_utf8_lossy(&self.text[self.begin..]).trim().to_owned()
    }

    pub(super) fn number(&self) -> Result<u64> {
        let value = self.value();
        let fault = |_| self.fault(self.begin + 1, "expected a whole number").value(&value);
        Ok(value.parse().map_err(fault)?)
    }

    pub(super) fn list(&self) -> Result<Vec<u64>> {
        let number = |word: &str| {
            let fault = |_| self.fault(self.begin + 1, "expected numbers of samples").value(word);
            word.parse().map_err(|error| Error::from(fault(error)))
        };
        self.value().split_ascii_whitespace().map(number).collect()
    }

    /// Packs the samples of a channel.
    pub(super) fn channel(&self, samples: u64, bits: &mut Vec<u64>) -> Result<()> {
        let (mut count, first) = (0, bits.len());
        bits.resize(first + samples.div_ceil(64) as usize, 0);
        for (place, &byte) in self.text.iter().enumerate().skip(self.begin) {
            let expected = match byte {
                b'0' | b'1' if count < samples => {
                    bits[first + count as usize / 64] |= u64::from(byte & 1) << (count % 64);
                    count += 1;
                    continue;
                }
                b'\r' | b'\n' => continue,
                b' ' if count == 0 => continue,
                b'0' | b'1' => format!("expected no more than {samples} samples (sample_count)"),
                _ => "expected 0 or 1".to_owned(),
            };
            return Err(self.fault(place + 1, expected).value(byte as char).into());
        }
        if count != samples {
            let text = format!("{count} samples, expected {samples} (sample_count)");
            return Err(self.fault(self.text.len(), text).into());
        }
        Ok(())
    }
}
