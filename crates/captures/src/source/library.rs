//! Values and errors of the crate `wellen`, as they are here.

use std::path::Path;

use wellen::{BitVecRef, FileFormat, SignalValueRef, States, WellenError};

use tofsim::error::{Error, Input};

/// A value in words.
#[derive(Default)]
pub(super) struct Words {
    /// Lowest word first.
    pub(super) value: Vec<u64>,
    /// Unknown bits.
    pub(super) unknown: Vec<u64>,
}

impl Words {
    /// Takes a value, in as many words as its signal has.
    #[inline]
    pub(super) fn set(&mut self, value: SignalValueRef<'_>, words: usize) {
        self.value.clear();
        self.unknown.clear();
        self.value.resize(words, 0);
        self.unknown.resize(words, 0);
        match value {
            SignalValueRef::BitVec(bits) => self.bits(bits),
            SignalValueRef::Real(real) => self.value[0] = real.to_bits(),
            SignalValueRef::Event | SignalValueRef::String(_) => {}
        }
    }

    #[inline]
    fn bits(&mut self, bits: BitVecRef<'_>) {
        if bits.states() == States::Two
            && let Some(bytes) = bits.be_bytes()
        {
            for (place, &byte) in bytes.iter().rev().enumerate() {
                self.value[place / 8] |= u64::from(byte) << (8 * (place % 8));
            }
            return;
        }
        for bit in 0..bits.width() {
            let (word, place) = (bit as usize / 64, bit % 64);
            let (value, unknown) = match u8::from(bits.get_bit(bit)) {
                0 | 7 => (0, 0),
                1 | 4 => (1, 0),
                3 => (1, 1),
                _ => (0, 1),
            };
            self.value[word] |= value << place;
            self.unknown[word] |= unknown << place;
        }
    }
}

/// An error of the library, with the line where that is known.
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
        WellenError::FailedToLoad(..) => {
            Input::new(source, "is damaged, or not as its format asks").into()
        }
    }
}
