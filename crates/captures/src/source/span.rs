//! Parser for the checks of binary waveforms.

use std::io;
use std::path::Path;

use tofsim::error::{Error, Input};

/// Reason why a binary waveform is refused.
#[derive(Debug)]
pub(super) enum Fault {
    /// The file cannot be read.
    Io(io::Error),
    /// Invalid field, with its value if it is a number.
    Wrong { field: String, value: Option<u64>, expected: String },
}

/// Result of a check.
pub(super) type Checked<T> = std::result::Result<T, Fault>;

impl Fault {
    /// Creates a fault for a value that `field` cannot have.
    pub(super) fn value(field: &str, value: u64, expected: impl Into<String>) -> Fault {
        Fault::Wrong { field: field.to_owned(), value: Some(value), expected: expected.into() }
    }

    /// Creates a fault for `field` without a value.
    pub(super) fn of(field: &str, expected: &str) -> Fault {
        Fault::Wrong { field: field.to_owned(), value: None, expected: expected.to_owned() }
    }

    /// Prefixes the field with a section that begins at byte `place`; `name` may end with a zero.
    pub(super) fn within_section(self, name: &[u8], place: usize) -> Fault {
        let name = String::from_utf8_lossy(name);
        self.within(&format!("section {} at byte {place}", name.trim_end_matches('\0')))
    }

    /// Prefixes the field with the one that contains it.
    pub(super) fn within(self, whole: &str) -> Fault {
        match self {
            Fault::Wrong { field, value, expected } => {
                Fault::Wrong { field: format!("{whole}: {field}"), value, expected }
            }
            io => io,
        }
    }

    /// Converts the fault to an error about the file at `path`.
    pub(super) fn of_file(self, path: &Path) -> Error {
        match self {
            Fault::Io(error) => Error::io(path, "read")(error),
            Fault::Wrong { field, value, expected } => {
                let input = Input::new(path.display(), expected).field(field);
                value.map_or(input.clone(), |value| input.value(value)).into()
            }
        }
    }
}

impl From<io::Error> for Fault {
    fn from(error: io::Error) -> Fault {
        Fault::Io(error)
    }
}

/// Checks that `value` is at most `most`.
pub(super) fn at_most(field: &str, value: u64, most: u64) -> Checked<u64> {
    if value <= most {
        Ok(value)
    } else {
        Err(Fault::value(field, value, format!("expected {most} at most")))
    }
}

/// Bytes that are parsed sequentially.
#[derive(Clone, Debug)]
pub(super) struct Span<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Name of the bytes in errors.
    what: &'static str,
    /// Whether the most significant byte of a word is its first.
    pub(super) is_big: bool,
}

impl<'a> Span<'a> {
    pub(super) fn new(bytes: &'a [u8], what: &'static str) -> Span<'a> {
        Span { bytes, at: 0, what, is_big: true }
    }

    /// Returns the number of bytes parsed.
    pub(super) fn place(&self) -> usize {
        self.at
    }

    /// Returns the number of bytes left.
    pub(super) fn left(&self) -> u64 {
        (self.bytes.len() - self.at) as u64
    }

    pub(super) fn take(&mut self, count: u64) -> Checked<&'a [u8]> {
        let end = usize::try_from(count).ok().and_then(|count| self.at.checked_add(count));
        let taken = end.and_then(|end| self.bytes.get(self.at..end));
        let taken = taken.ok_or_else(|| Fault::of(self.what, "ends too early"))?;
        self.at += taken.len();
        Ok(taken)
    }

    #[inline]
    pub(super) fn byte(&mut self) -> Checked<u8> {
        Ok(self.take(1)?[0])
    }

    /// Parses an integer of `size` bytes.
    pub(super) fn word(&mut self, size: u64) -> Checked<u64> {
        let bytes = self.take(size)?.iter();
        let add = |word, &byte: &u8| word << 8 | u64::from(byte);
        Ok(if self.is_big { bytes.fold(0, add) } else { bytes.rev().fold(0, add) })
    }

    /// Parses an unsigned LEB128 integer.
    #[inline]
    pub(super) fn number(&mut self) -> Checked<u64> {
        let mut number = 0;
        for group in 0..10 {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f) << (7 * group);
            if byte & 0x80 == 0 {
                return Ok(number);
            }
        }
        Err(Fault::of(self.what, "expected a number of 64 bits at most"))
    }

    /// Parses a signed LEB128 integer.
    pub(super) fn signed(&mut self) -> Checked<i64> {
        let begin = self.at;
        let number = self.number()?;
        let unused = 64u32.saturating_sub(7 * (self.at - begin) as u32);
        Ok((number << unused) as i64 >> unused)
    }

    /// Parses the number of items that follow, of at least one byte each.
    pub(super) fn count(&mut self, field: &str) -> Checked<u64> {
        let count = self.number()?;
        at_most(field, count, self.left()).map_err(|fault| fault.within(self.what))
    }

    /// Parses the four-byte number of items that follow, of at least one byte each.
    pub(super) fn items(&mut self, field: &str) -> Checked<u64> {
        let count = self.word(4)?;
        at_most(field, count, self.left())
    }

    /// Parses a zero-terminated text.
    pub(super) fn text(&mut self) -> Checked<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&byte| byte == 0);
        let text = self.take(length.map_or(u64::MAX, |length| length as u64))?;
        self.at += 1;
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_texts_come_one_after_the_other() {
        let mut span = Span::new(&[0x05, 0xe5, 0x8e, 0x26, 0x7b, b'a', b'b', 0, 2, 9], "bytes");
        assert_eq!(span.number().unwrap(), 5);
        assert_eq!(span.number().unwrap(), 624_485);
        assert_eq!(span.signed().unwrap(), -5);
        assert_eq!(span.text().unwrap(), b"ab");
        let error = span.count("items").unwrap_err().of_file(Path::new("a.fst"));
        assert_eq!(error.to_string(), "a.fst: bytes: items = 2: expected 1 at most");
        assert_eq!(span.left(), 1);
    }

    #[test]
    fn bytes_that_are_not_there_are_a_fault() {
        let told = |result: Checked<u64>| result.unwrap_err().of_file(Path::new("a")).to_string();
        assert_eq!(told(Span::new(&[0x80, 0x80], "names").number()), "a: names: ends too early");
        let expected = "a: names: expected a number of 64 bits at most";
        assert_eq!(told(Span::new(&[0xff; 12], "names").number()), expected);
        assert!(Span::new(b"no zero", "names").text().is_err());
        assert!(Span::new(b"", "names").take(u64::MAX).is_err());
    }
}
