//! Sources in which words are replaced by the values that they represent, or values by those of the same names.

use std::collections::HashMap;
use std::sync::Arc;

use tofsim::error::Result;

use crate::ila::Radix;
use crate::ila::read::{LONGEST_WORD, digits, word};
use crate::words::{Bits, fill};

use super::signals::{self, Signal, SignalKind, Source};
use super::stream::Cursor;

/// Values of a signal's words, or of its states.
#[derive(Clone, Debug)]
pub(crate) enum Translation {
    /// Words become values.
    Words(WordValues),
    /// Values become other values of a width [bits]. Those that have none become unknown, with the value beyond the
    /// width, so that they equal no other ([`untranslated`]).
    Codes(u32, HashMap<u64, u64>),
}

/// Values of words.
#[derive(Clone, Debug)]
pub(crate) struct WordValues {
    /// Width of the values [bits].
    pub(crate) width: u32,
    /// Radix of the numbers among the words.
    pub(crate) radix: Option<Radix>,
    /// Value of each word.
    pub(crate) states: HashMap<String, u64>,
}

impl Translation {
    /// Returns the width of the new values [bits].
    fn width(&self) -> u32 {
        match self {
            Translation::Words(words) => words.width,
            Translation::Codes(width, _) => *width,
        }
    }

    /// Returns the new value.
    fn bits(&self, value: &[u64], unknown: &[u64]) -> Bits {
        let (width, codes) = match self {
            Translation::Words(words) => return words.bits(value),
            Translation::Codes(width, codes) => (*width, codes),
        };
        let mut bits = Bits::zero(width);
        let is_known = unknown.iter().all(|&word| word == 0);
        let known = value.first().copied().filter(|_| is_known);
        if let Some(code) = known.and_then(|value| codes.get(&value)) {
            bits.value[0] = *code;
            return bits;
        }
        fill(&mut bits.unknown, width);
        bits.value[0] = known.and_then(|value| beyond(value, width)).unwrap_or(0);
        bits
    }
}

/// Returns a word that has a value above its lowest `width` bits, if there is room.
fn beyond(value: u64, width: u32) -> Option<u64> {
    let above = value.checked_add(1)?;
    (width < above.leading_zeros()).then(|| above << width)
}

/// Returns the value of a signal of `width` bits that has no translation.
pub(crate) fn untranslated(bits: &Bits, width: u32) -> Option<u64> {
    let word = bits.value.first().filter(|_| bits.value.len() == 1)?;
    word.checked_shr(width).filter(|&above| above > 0).map(|above| above - 1)
}

impl WordValues {
    /// Returns the value of a word; all bits are unknown if the word is.
    fn bits(&self, value: &[u64]) -> Bits {
        let cell = word(value);
        let mut bits = Bits::zero(self.width);
        if let Some(&state) = self.states.get(&cell) {
            bits.value[0] = state;
            return bits;
        }
        let read = self.radix.map(|radix| digits::read(cell.as_bytes(), radix, self.width));
        read.and_then(std::result::Result::ok).unwrap_or_else(|| {
            fill(&mut bits.unknown, self.width);
            bits
        })
    }
}

/// The original source, and the translations by id.
#[derive(Debug)]
struct Translated {
    origin: Arc<dyn signals::Origin>,
    by_id: HashMap<usize, Translation>,
    /// Widths of the translated signals in the source [bits].
    widths: HashMap<usize, u32>,
}

impl Source {
    /// Returns the source with the words or values of some signals, by id, replaced by values.
    pub(crate) fn translated(mut self, by_id: HashMap<usize, Translation>) -> Source {
        let of = |signal: &Signal| (signal.id, signal.width);
        let widths = self.signals.iter().map(of).collect();
        let is_it =
            |signal: &&mut Signal| [SignalKind::Text, SignalKind::Bits].contains(&signal.kind);
        for signal in self.signals.iter_mut().filter(is_it) {
            if let Some(translation) = by_id.get(&signal.id) {
                (signal.kind, signal.width) = (SignalKind::Bits, translation.width());
            }
        }
        self.origin = Arc::new(Translated { origin: self.origin, by_id, widths });
        self
    }
}

impl signals::Origin for Translated {
    fn read(&self, ids: &[usize], widths: &[u32]) -> Result<Cursor> {
        let of: Vec<_> = ids.iter().map(|id| self.by_id.get(id).cloned()).collect();
        let inner = widths.iter().zip(&of).enumerate();
        let inner = inner.map(|(place, (&width, translation))| match translation {
            Some(Translation::Words(_)) => 8 * LONGEST_WORD as u32,
            Some(Translation::Codes(..)) => self.widths[&ids[place]],
            None => width,
        });
        let mut cursor = self.origin.read(ids, &inner.collect::<Vec<_>>())?;
        Ok(Cursor::spawn(widths, move |feed| {
            let mut changed = Vec::new();
            while let Some(at) = cursor.peek()? {
                if feed.at(at).is_err() {
                    return Ok(());
                }
                let marks = cursor.take(|signal| changed.push(signal));
                feed.mark(|mark| *mark = marks);
                for signal in changed.drain(..) {
                    let (value, unknown) =
                        (cursor.state.value(signal), cursor.state.unknown(signal));
                    match &of[signal] {
                        Some(translation) => {
                            let bits = translation.bits(value, unknown);
                            feed.change(signal, &bits.value, &bits.unknown);
                        }
                        None => feed.change(signal, value, unknown),
                    }
                }
            }
            Ok(())
        }))
    }
}
