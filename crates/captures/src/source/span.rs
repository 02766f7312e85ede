//! Bytes of a binary waveform, looked through before a library makes room for what they say.

use std::io;
use std::path::Path;

use tofsim::error::{Error, Input};

/// Why a binary waveform is not read.
#[derive(Debug)]
pub(super) enum Fault {
    /// The file cannot be read.
    Io(io::Error),
    /// A number in it, or what is wrong with it.
    Wrong { field: String, value: Option<u64>, expected: String },
}

/// What a check finds.
pub(super) type Checked<T> = std::result::Result<T, Fault>;

impl Fault {
    /// That `field` has a value that it cannot have.
    pub(super) fn value(field: &str, value: u64, expected: impl Into<String>) -> Fault {
        Fault::Wrong { field: field.to_owned(), value: Some(value), expected: expected.into() }
    }

    /// That something is wrong with `field`.
    pub(super) fn of(field: &str, expected: &str) -> Fault {
        Fault::Wrong { field: field.to_owned(), value: None, expected: expected.to_owned() }
    }

    /// The same of a field within another.
    pub(super) fn within(self, whole: &str) -> Fault {
        match self {
            Fault::Wrong { field, value, expected } => {
                Fault::Wrong { field: format!("{whole}: {field}"), value, expected }
            }
            io => io,
        }
    }

    /// The error about the file at `path`.
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

/// That `value` is `most` at most.
pub(super) fn at_most(field: &str, value: u64, most: u64) -> Checked<u64> {
    match value <= most {
        true => Ok(value),
        false => Err(Fault::value(field, value, format!("expected {most} at most"))),
    }
}

/// Bytes that are taken one after the other.
#[derive(Clone, Debug)]
pub(super) struct Span<'a> {
    bytes: &'a [u8],
    at: usize,
    /// What they are, for an error.
    what: &'static str,
}

impl<'a> Span<'a> {
    pub(super) fn new(bytes: &'a [u8], what: &'static str) -> Span<'a> {
        Span { bytes, at: 0, what }
    }

    /// How many have been taken.
    pub(super) fn place(&self) -> usize {
        self.at
    }

    /// How many are left.
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

    /// A number in groups of seven bits, the lowest first.
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

    /// The same in two's complement.
    pub(super) fn signed(&mut self) -> Checked<i64> {
        let begin = self.at;
        let number = self.number()?;
        let unused = 64u32.saturating_sub(7 * (self.at - begin) as u32);
        Ok((number << unused) as i64 >> unused)
    }

    /// A number that says how many things follow, of a byte each or more.
    pub(super) fn count(&mut self, field: &str) -> Checked<u64> {
        let count = self.number()?;
        at_most(field, count, self.left()).map_err(|fault| fault.within(self.what))
    }

    /// A text up to a zero.
    pub(super) fn text(&mut self) -> Checked<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&byte| byte == 0);
        let text = self.take(length.map_or(u64::MAX, |length| length as u64))?;
        self.at += 1;
        Ok(text)
    }
}

/// Eight bytes as a number, the highest first.
pub(super) fn word(bytes: &[u8]) -> u64 {
    bytes.iter().take(8).fold(0, |word, &byte| word << 8 | u64::from(byte))
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
