//! A pair of signals, and how they are compared.

use std::sync::Arc;

use serde::Serialize;
use strum::Display;

use crate::ila::read::NamedValue;
use crate::source::{Signal, SignalKind, SourceState, untranslated};
use crate::words::{Bits, extend, ones};

use super::parts::{Part, Slots, gather};
use super::show::Show;

/// Treatment of unknown bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unknowns {
    /// x equals only x
    #[default]
    Exact,
    /// x equals anything
    Any,
    /// x equals nothing, not even x
    None,
}

/// Rule by which two signals were matched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Display, Serialize)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum MatchedBy {
    /// The names are equal.
    #[default]
    Name,
    /// One name is a suffix of the other.
    Suffix,
    /// The names have a common ending that no other signal has.
    Tail,
    /// The map matches them.
    Map,
}

/// Two signals to compare, by default at every place and bit for bit.
#[derive(Clone, Debug, Default)]
pub(super) struct Pair {
    /// Displayed name: that of the first side.
    pub(super) name: String,
    /// Name on the second side.
    pub(super) other: String,
    /// Number of further names of the same two signals.
    pub(super) aliases: usize,
    pub(super) how: MatchedBy,
    pub(super) width: u32,
    pub(super) sides: [Vec<Part>; 2],
    pub(super) show: Show,
    /// Names of the values of each side.
    pub(super) states: [Arc<[NamedValue]>; 2],
    /// Whether it has events, which occur on both sides at the same places, instead of values.
    pub(super) is_event: bool,
    /// Whether conditions interpret it as two's complement, if the map states it.
    pub(super) signed: Option<bool>,
    /// Mask of the bits to compare, least significant word first; empty for all.
    pub(super) mask: Vec<u64>,
    pub(super) invert: bool,
    /// Whether a side has words of unknown value, which cannot be compared.
    pub(super) has_words: bool,
    pub(super) latency: i64,
    pub(super) tolerance: u64,
    /// Signal of the first side's cursor that must be 1 for a comparison.
    pub(super) valid: Option<usize>,
}

impl Pair {
    /// Creates a pair of two whole signals.
    pub(super) fn whole([a, b]: [&Signal; 2], how: MatchedBy, slots: &mut [Slots; 2]) -> Pair {
        let ([left, right], is_event) = (slots, a.kind == SignalKind::Event);
        Pair {
            name: a.name.text.clone(),
            other: b.name.text.clone(),
            how,
            width: if is_event { 1 } else { a.width },
            sides: [vec![Part::whole(left, a)], vec![Part::whole(right, b)]],
            show: Show::of(a, b),
            states: [a, b].map(|signal| Arc::clone(&signal.words.states)),
            is_event,
            ..Pair::default()
        }
    }

    /// Formats a value in the first side's form: with its name, if it has one.
    pub(super) fn text(&self, bits: &Bits) -> String {
        let named = |side: usize, value: u64| {
            let mut states = self.states[side].iter();
            let found = states.find(|state| state.bits == Some(value))?;
            Some(format!("{} ({value})", found.name))
        };
        if let Some(value) = untranslated(bits, self.width) {
            return named(1, value).unwrap_or_else(|| format!("no state ({value})"));
        }
        let value = bits.number().and_then(|value| u64::try_from(value).ok());
        let name = value.and_then(|value| named(0, value).or_else(|| named(1, value)));
        name.unwrap_or_else(|| self.show.text(bits, self.width))
    }

    /// Returns whether the pair is compared bit for bit, at one place at a time.
    pub(super) fn is_plain(&self) -> bool {
        self.latency == 0 && self.valid.is_none()
    }

    /// Returns whether the pair is excluded from the comparison, given the values of the first side.
    #[inline]
    pub(super) fn is_off(&self, state: &SourceState) -> bool {
        self.valid.is_some_and(|valid| state.value(valid)[0] != 1 || state.unknown(valid)[0] != 0)
    }

    /// Collects the value of one side; that of the second is converted to the first's form.
    pub(super) fn gather(&self, side: usize, state: &SourceState, bits: &mut Bits) {
        gather(&self.sides[side], state, bits);
        if side == 1 && self.invert {
            for (k, word) in bits.value.iter_mut().enumerate() {
                let all = ones(self.width, k);
                *word = (!*word & !bits.unknown[k] & all) | (*word & bits.unknown[k]);
            }
        }
    }

    /// Clears the bits that are not compared.
    pub(super) fn mask(&self, bits: &mut Bits) {
        for (k, mask) in self.mask.iter().enumerate() {
            for word in [&mut bits.value, &mut bits.unknown] {
                if let Some(word) = word.get_mut(k) {
                    *word &= mask;
                }
            }
        }
    }

    /// Collects the values of both sides.
    pub(super) fn gather_both(&self, states: [&SourceState; 2], bits: &mut [Bits; 2]) {
        for (side, bits) in bits.iter_mut().enumerate() {
            self.gather(side, states[side], bits);
        }
    }

    /// Returns whether the sides are equal, given the states of both cursors.
    #[inline]
    pub(super) fn same(
        &self,
        states: [&SourceState; 2],
        unknowns: Unknowns,
        scratch: &mut [Bits; 2],
    ) -> bool {
        if let ([a], [b]) = (&self.sides[0][..], &self.sides[1][..])
            && a.whole
            && b.whole
            && self.mask.is_empty()
            && unknowns == Unknowns::Exact
            && !self.invert
            && states[0].value(a.signal) == states[1].value(b.signal)
            && states[0].unknown(a.signal) == states[1].unknown(b.signal)
        {
            return true;
        }
        self.gather_both(states, scratch);
        let [a, b] = scratch;
        self.equal(a, b, unknowns)
    }

    /// Returns whether two values are equal.
    pub(super) fn equal(&self, a: &Bits, b: &Bits, unknowns: Unknowns) -> bool {
        let unknowns = if self.has_words { Unknowns::Any } else { unknowns };
        let differs = |k: usize| {
            let unknown = a.unknown[k] | b.unknown[k];
            let bits = match unknowns {
                Unknowns::Exact => (a.value[k] ^ b.value[k]) | (a.unknown[k] ^ b.unknown[k]),
                Unknowns::Any => (a.value[k] ^ b.value[k]) & !unknown,
                Unknowns::None => (a.value[k] ^ b.value[k]) | unknown,
            };
            bits & self.mask.get(k).copied().unwrap_or(u64::MAX) != 0
        };
        if !(0..a.value.len()).any(differs) {
            return true;
        }
        self.tolerance > 0 && self.is_near(a, b)
    }

    fn is_near(&self, a: &Bits, b: &Bits) -> bool {
        let (Some(a), Some(b)) = (a.number(), b.number()) else { return false };
        let apart = if self.show.is_signed() {
            extend(a, self.width).abs_diff(extend(b, self.width))
        } else {
            a.abs_diff(b)
        };
        self.show != Show::Real && apart <= self.tolerance as u128
    }
}
