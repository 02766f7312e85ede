//! Conversion of the crate `wellen`'s values and errors.

use std::borrow::Cow;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use wellen::{BitVecRef, FileFormat, SignalValueRef, States, WellenError};

use tofsim::error::{Error, Input};

use crate::ila::read::{LONGEST_WORD, put_word};
use crate::words::Bits;

use super::guard::DAMAGED;
use super::signals::SourceFormat;

/// Converts a value, with the number of words of its signal; that of an event is left to the caller.
#[inline]
pub(super) fn set(bits: &mut Bits, value: SignalValueRef<'_>, words: usize, format: SourceFormat) {
    bits.clear(words);
    match value {
        SignalValueRef::BitVec(found) => copy(found, bits),
        SignalValueRef::Real(real) => bits.value[0] = real.to_bits(),
        SignalValueRef::String(text) if format == SourceFormat::Vcd => {
            put_word(shortened(&decoded(text)).as_bytes(), &mut bits.value);
        }
        SignalValueRef::String(text) => put_word(shortened(text).as_bytes(), &mut bits.value),
        SignalValueRef::Event => {}
    }
}

/// Returns the text of a VCD. wellen 0.25.7 makes a character of each byte of a text with a backslash.
fn decoded(text: &str) -> Cow<'_, str> {
    if text.is_ascii() {
        return text.into();
    }
    let bytes: Option<Vec<u8>> = text.chars().map(|one| u8::try_from(one).ok()).collect();
    let decoded = bytes.and_then(|bytes| String::from_utf8(bytes).ok());
    decoded.map_or(text.into(), Cow::Owned)
}

/// Mark of a text that is its beginning and a hash.
const SHORTENED: &str = "..(hash ";

/// Returns whether a text of a waveform is the beginning of a longer one.
pub(crate) fn is_shortened(text: &str) -> bool {
    text.len() > LONGEST_WORD - 30 && text.ends_with(')') && text.contains(SHORTENED)
}

/// Returns a text that fits a signal's words: a long one is its beginning and a hash of the whole.
fn shortened(text: &str) -> Cow<'_, str> {
    if text.len() <= LONGEST_WORD {
        return text.into();
    }
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    let hash = format!("{SHORTENED}{:016x})", hasher.finish());
    let begin = &text[..text.floor_char_boundary(LONGEST_WORD - hash.len())];
    (begin.to_owned() + &hash).into()
}

#[inline]
fn copy(found: BitVecRef<'_>, bits: &mut Bits) {
    if found.states() == States::Two
        && let Some(bytes) = found.be_bytes()
    {
        for (place, &byte) in bytes.iter().rev().enumerate() {
            bits.value[place / 8] |= u64::from(byte) << (8 * (place % 8));
        }
        return;
    }
    for bit in 0..found.width() {
        let (word, place) = (bit as usize / 64, bit % 64);
        let (value, unknown) = match u8::from(found.get_bit(bit)) {
            0 | 7 => (0, 0),
            1 | 4 => (1, 0),
            3 => (1, 1),
            _ => (0, 1),
        };
        bits.value[word] |= value << place;
        bits.unknown[word] |= unknown << place;
    }
}

/// Converts an error, with the line if it is known.
pub(super) fn fault(path: &Path, error: WellenError) -> Error {
    let source = path.display();
    match error {
        WellenError::Io(error) => Error::io(path, "read")(error),
        WellenError::UnknownFileFormat => {
            Input::new(source, "expected a VCD, FST or GHW waveform, or an ILA capture").into()
        }
        WellenError::FailedToLoad(FileFormat::Vcd, text) => {
            let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
            Input::new(source, format!("cannot be read: {text}")).into()
        }
        WellenError::FailedToLoad(..) => Input::new(source, DAMAGED).into(),
    }
}
