//! Signals and values of a waveform of any design.

use std::borrow::Cow;
use std::io;
use std::sync::Arc;

use crate::error::Result;

/// Type of a signal's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DumpKind {
    /// Levels, with their number [bits].
    Bits(u32),
    /// Floating-point number.
    Real,
    /// Text.
    Text,
    /// No value, only events.
    Event,
}

/// Name of a state, and its value.
pub type DumpState = (String, u64);

/// What a waveform says of a signal.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SignalDescription {
    /// Type, such as `signed/2^29[m]`, or a type of the design's language; empty if it is not known.
    pub value_type: String,
    /// Meaning; empty if it is not known.
    pub meaning: String,
}

/// A signal under one of its names.
#[derive(Clone, Debug)]
pub struct DumpSignal {
    /// Scopes, outermost first.
    pub scopes: Arc<[String]>,
    /// Name without scopes and range.
    pub name: String,
    /// Indices of the highest and the lowest bit, if they are part of the name.
    pub range: Option<[i64; 2]>,
    /// Type of its values.
    pub kind: DumpKind,
    /// Its states; empty if it has none.
    pub states: Arc<[DumpState]>,
    /// Its description, if it has one.
    pub description: Option<Arc<SignalDescription>>,
    /// Id, which all names of the signal share; ids count from 0.
    pub id: usize,
}

impl DumpSignal {
    /// Returns its scopes, outermost first.
    pub(crate) fn scopes(&self) -> Vec<&str> {
        self.scopes.iter().map(String::as_str).collect()
    }

    /// Formats the range, such as `[7:0]`.
    pub(crate) fn range_text(&self) -> Option<String> {
        self.range.map(|[high, low]| match self.kind {
            DumpKind::Bits(1) if high == low => format!("[{high}]"),
            _ => format!("[{high}:{low}]"),
        })
    }

    /// Formats the table of states: a name, their number, their names, and their values in binary.
    pub(crate) fn table(&self, number: u64) -> String {
        let width = if let DumpKind::Bits(width) = self.kind { width as usize } else { 1 };
        let mut text = format!("states_{number} {}", self.states.len());
        self.states.iter().for_each(|(name, _)| text += &format!(" {}", escaped(name)));
        self.states.iter().for_each(|(_, value)| text += &format!(" {value:0width$b}"));
        text
    }
}

/// A value.
#[derive(Clone, Copy, Debug)]
pub enum DumpValue<'a> {
    /// Levels, least significant word first; unknown ones are 0 for `x` and 1 for `z`.
    Bits {
        /// Value.
        value: &'a [u64],
        /// Mask of the unknown bits.
        unknown: &'a [u64],
    },
    /// Floating-point number.
    Real(f64),
    /// Text.
    Text(&'a str),
    /// Event.
    Event,
}

impl DumpValue<'_> {
    /// Returns the digit of a level.
    pub fn digit(value: &[u64], unknown: &[u64], bit: u32) -> u8 {
        let of = |words: &[u64]| words[bit as usize / 64] >> (bit % 64) & 1;
        match (of(unknown), of(value)) {
            (0, 0) => b'0',
            (0, _) => b'1',
            (_, 0) => b'x',
            _ => b'z',
        }
    }
}

/// A waveform file under construction. If it is dropped before its end, no file remains.
pub trait Dump {
    /// Sets the time of the changes that follow, which must not decrease, in units of the file.
    ///
    /// # Errors
    /// If the file cannot be written.
    fn begin(&mut self, at: u64) -> io::Result<()>;

    /// Writes a change of a signal, by its id.
    ///
    /// # Errors
    /// If the file cannot be written.
    fn change(&mut self, id: usize, value: DumpValue<'_>) -> io::Result<()>;

    /// Ends the file at a time, and moves it to its path.
    ///
    /// # Errors
    /// If the file cannot be written.
    fn finish(self: Box<Self>, at: u64) -> Result<()>;
}

/// Replaces what cannot be part of a word in a waveform by backslash sequences, as GTKWave's tools do.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '\\' | '\'' | '"' | '?' => escaped.extend(['\\', character]),
            '!'..='~' => escaped.push(character),
            _ => {
                let mut bytes = [0; 4];
                let bytes = character.encode_utf8(&mut bytes).bytes();
                bytes.for_each(|byte| escaped += &format!("\\{byte:03o}"));
            }
        }
    }
    escaped
}

/// Replaces the backslash sequences of [`escaped`], and others of C, by what they stand for.
pub fn unescaped(text: &str) -> Cow<'_, str> {
    if !text.contains('\\') {
        return text.into();
    }
    let (mut bytes, mut rest) = (Vec::new(), text.as_bytes());
    while let [first, behind @ ..] = rest {
        rest = behind;
        let (byte, length) = match (first, behind) {
            (b'\\', [b'x', digits @ ..]) => {
                number(digits, 16, 2).map_or((b'x', 1), |n| (n.0, n.1 + 1))
            }
            (b'\\', [b'0'..=b'7', ..]) => number(behind, 8, 3).unwrap_or((b'0', 1)),
            (b'\\', [b'a', ..]) => (7, 1),
            (b'\\', [b'b', ..]) => (8, 1),
            (b'\\', [b't', ..]) => (b'\t', 1),
            (b'\\', [b'n', ..]) => (b'\n', 1),
            (b'\\', [b'v', ..]) => (11, 1),
            (b'\\', [b'f', ..]) => (12, 1),
            (b'\\', [b'r', ..]) => (b'\r', 1),
            (b'\\', [other, ..]) => (*other, 1),
            _ => (*first, 0),
        };
        bytes.push(byte);
        rest = &rest[length..];
    }
    String::from_utf8_lossy(&bytes).into_owned().into()
}

/// Parses at most `most` digits, and returns their byte and number.
fn number(digits: &[u8], radix: u32, most: usize) -> Option<(u8, usize)> {
    let is_digit = |byte: &&u8| char::from(**byte).is_digit(radix);
    let count = digits.iter().take(most).take_while(is_digit).count();
    let text = std::str::from_utf8(&digits[..count]).ok()?;
    Some((u32::from_str_radix(text, radix).ok()? as u8, count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_escaped_as_fst2vcd_does() {
        assert_eq!(escaped("' '"), "\\'\\040\\'");
        assert_eq!(escaped("a\\b\tµ"), "a\\\\b\\011\\302\\265");
    }

    #[test]
    fn what_is_escaped_is_unescaped_again() {
        for text in ["' '", "a\\b\tµ", "\u{1}\u{7f}?\"", "plain", ""] {
            assert_eq!(unescaped(&escaped(text)), text);
        }
        assert_eq!(unescaped("\\x41\\x4g\\101\\n\\q\\"), "A\u{4}gA\nq\\");
    }

    #[test]
    fn a_table_has_names_and_then_values_of_the_signal_s_width() {
        let states = Arc::new([("idle".to_owned(), 0), ("' '".to_owned(), 2)]);
        let (scopes, name, kind) = (Arc::default(), "s".to_owned(), DumpKind::Bits(2));
        let signal =
            DumpSignal { scopes, name, range: None, kind, states, description: None, id: 0 };
        assert_eq!(signal.table(3), "states_3 2 idle \\'\\040\\' 00 10");
    }
}
