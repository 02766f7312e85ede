//! Two signals that are compared, and how.

use crate::source::{Signal, State};

use super::find::Slots;
use super::show::Show;

/// Bits of a signal of a cursor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part {
    /// Signal of the cursor.
    pub(super) signal: usize,
    /// Lowest bit.
    pub(super) low: u32,
    /// Number of bits.
    pub(super) width: u32,
    /// Whether that is the whole signal.
    pub(super) whole: bool,
}

impl Part {
    /// All of a signal, which is read from now on.
    pub(super) fn whole(slots: &mut Slots, signal: &Signal) -> Self {
        Part { signal: slots.place(signal.id), low: 0, width: signal.width, whole: true }
    }
}

/// What an unknown bit is the same as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unknowns {
    /// x only is x
    #[default]
    Exact,
    /// x is anything
    Any,
    /// x is nothing, not even x
    None,
}

/// How two signals came together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum How {
    /// The names are the same.
    Name,
    /// One name is the end of the other.
    Suffix,
    /// The map says so.
    Map,
}

/// Two signals that are compared.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    /// Name that it is shown by: the first side's.
    pub(super) name: String,
    /// Name on the second side.
    pub(super) other: String,
    /// More names of the same two signals.
    pub(super) aliases: usize,
    pub(super) how: How,
    pub(super) width: u32,
    pub(super) sides: [Vec<Part>; 2],
    pub(super) show: Show,
    /// Whether conditions take it as two's complement, if the map says.
    pub(super) signed: Option<bool>,
    /// Bits that are compared, lowest word first; empty if all are.
    pub(super) mask: Vec<u64>,
    pub(super) invert: bool,
    pub(super) latency: i64,
    pub(super) tolerance: u64,
    /// Signal of the first side's cursor that has to be 1.
    pub(super) valid: Option<usize>,
}

/// A value in words: bits, and which of them are unknown.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Bits {
    pub(super) value: Vec<u64>,
    pub(super) unknown: Vec<u64>,
}

impl Bits {
    /// Whether no bit is unknown.
    pub(super) fn is_known(&self) -> bool {
        self.unknown.iter().all(|&word| word == 0)
    }

    /// The value, if it has at most 128 bits, all known.
    pub(super) fn number(&self) -> Option<u128> {
        let low = self.value.first().copied().unwrap_or(0);
        let high = self.value.get(1).copied().unwrap_or(0);
        (self.value.len() <= 2 && self.is_known()).then_some(low as u128 | (high as u128) << 64)
    }
}

impl Pair {
    /// Two signals of so many bits that are compared at every place, bit for bit.
    pub(super) fn new(
        names: [String; 2],
        how: How,
        width: u32,
        sides: [Vec<Part>; 2],
        show: Show,
    ) -> Self {
        let [name, other] = names;
        Pair {
            name,
            other,
            aliases: 0,
            how,
            width,
            sides,
            show,
            signed: None,
            mask: Vec::new(),
            invert: false,
            latency: 0,
            tolerance: 0,
            valid: None,
        }
    }

    /// Whether it is compared by the bits at one place alone.
    pub(super) fn is_plain(&self) -> bool {
        self.latency == 0 && self.valid.is_none()
    }

    /// Whether it is not compared, where the first side has those values.
    #[inline]
    pub(super) fn is_off(&self, state: &State) -> bool {
        self.valid.is_some_and(|valid| state.value(valid)[0] != 1 || state.unknown(valid)[0] != 0)
    }

    /// Collects the value of one side, the second's as the first should have it.
    pub(super) fn gather(&self, side: usize, state: &State, bits: &mut Bits) {
        let words = (self.width as usize).div_ceil(64);
        bits.value.clear();
        bits.unknown.clear();
        if let [part] = self.sides[side][..]
            && part.whole
        {
            bits.value.extend_from_slice(state.value(part.signal));
            bits.unknown.extend_from_slice(state.unknown(part.signal));
        } else {
            bits.value.resize(words, 0);
            bits.unknown.resize(words, 0);
            let mut low = self.width;
            for part in &self.sides[side] {
                low -= part.width;
                put(&mut bits.value, low, state.value(part.signal), part);
                put(&mut bits.unknown, low, state.unknown(part.signal), part);
            }
        }
        if side == 1 && self.invert {
            for (k, word) in bits.value.iter_mut().enumerate() {
                let all = top(self.width, k);
                *word = (!*word & !bits.unknown[k] & all) | (*word & bits.unknown[k]);
            }
        }
    }

    /// Whether the sides are the same, the values being in the states of the two cursors.
    #[inline]
    pub(super) fn same(
        &self,
        states: [&State; 2],
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
        let [a, b] = scratch;
        self.gather(0, states[0], a);
        self.gather(1, states[1], b);
        self.equal(a, b, unknowns)
    }

    /// Whether two values are the same.
    pub(super) fn equal(&self, a: &Bits, b: &Bits, unknowns: Unknowns) -> bool {
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
        let apart = match self.show.is_signed() {
            true => extend(a, self.width).abs_diff(extend(b, self.width)),
            false => a.abs_diff(b),
        };
        self.show != Show::Real && apart <= self.tolerance as u128
    }
}

/// A two's complement number of `width` bits.
pub(super) fn extend(value: u128, width: u32) -> i128 {
    let shift = 128 - width.clamp(1, 128);
    ((value << shift) as i128) >> shift
}

/// The bits that word `k` of a signal of `width` bits has.
pub(super) fn top(width: u32, k: usize) -> u64 {
    match (width as usize).saturating_sub(64 * k) {
        0 => 0,
        bits if bits >= 64 => u64::MAX,
        bits => (1 << bits) - 1,
    }
}

/// Puts the bits of `part` into `words` from bit `low` on.
fn put(words: &mut [u64], low: u32, from: &[u64], part: &Part) {
    for bit in 0..part.width {
        let (source, target) = (part.low + bit, low + bit);
        let value = from[source as usize / 64] >> (source % 64) & 1;
        words[target as usize / 64] |= value << (target % 64);
    }
}

impl How {
    /// In a word.
    pub const fn word(self) -> &'static str {
        match self {
            How::Name => "name",
            How::Suffix => "suffix",
            How::Map => "map",
        }
    }
}
