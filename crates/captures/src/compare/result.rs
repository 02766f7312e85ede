//! What a comparison has found.

mod beats;

use serde::Serialize;

use crate::source::{Axis, Source};

use super::matching::Unmatched;
use super::pair::MatchedBy;

pub use beats::{BeatDifference, BeatKind, BeatPlace, Beats};

/// What a comparison has found.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    /// Names and formats of the two sides.
    pub sides: [Described; 2],
    /// What is compared of each pair: `changes` or `samples`.
    pub unit: &'static str,
    /// How the sides were brought together.
    pub alignment: String,
    /// Samples that the second side is later, if it is one number.
    pub offset: Option<i64>,
    /// Places compared.
    pub compared: u64,
    /// Results for each pair, the first to differ first, in the order of data flow.
    pub pairs: Vec<Compared>,
    /// Signals without a partner.
    pub unmatched: Vec<Unmatched>,
    /// Differences that are not of one signal's values.
    pub differences: Vec<String>,
    /// What the differences look like.
    pub findings: Vec<Finding>,
    /// What was found of the words that a bus accepts, where these are compared.
    pub beats: Option<Beats>,
    /// What a user may not expect.
    pub notes: Vec<String>,
}

/// What some differences look like.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// A word for it.
    pub kind: &'static str,
    /// The finding in a sentence.
    pub text: String,
    /// Signals that it explains, by their names on the first side.
    pub signals: Vec<String>,
}

impl Finding {
    pub(super) fn new(kind: &'static str, signals: &[&str], text: String) -> Self {
        Finding { kind, text, signals: signals.iter().map(|&name| name.to_owned()).collect() }
    }
}

/// A side, for people.
#[derive(Clone, Debug, Default)]
pub struct Described {
    /// Path or scenario.
    pub name: String,
    /// Format.
    pub format: &'static str,
    /// What its places are counted in.
    pub axis: Axis,
}

impl Described {
    pub(super) fn new(source: &Source) -> Self {
        let (name, format) = (source.name.clone(), source.format.name());
        Described { name, format, axis: source.axis }
    }

    /// A place in it, for people.
    pub fn place(&self, at: u64) -> String {
        let Some(fs) = self.axis.femtoseconds(at) else { return format!("sample {at}") };
        let text = format!("{}.{:06}", fs / 1_000_000, fs % 1_000_000);
        format!("{} ns", text.trim_end_matches('0').trim_end_matches('.'))
    }

    /// A place in it: picoseconds, or a sample's number.
    pub fn number(&self, at: u64) -> f64 {
        self.axis.femtoseconds(at).map_or(at as f64, |fs| fs as f64 / 1e3)
    }
}

/// The result for one pair.
#[derive(Clone, Debug, Serialize)]
pub struct Compared {
    /// Name on the first side.
    pub name: String,
    /// Name on the second side.
    pub other: String,
    /// How they came together.
    #[serde(rename = "matched_by")]
    pub how: MatchedBy,
    /// Further names of the same signals.
    pub aliases: usize,
    /// Width [bits].
    pub width: u32,
    /// Places compared.
    pub compared: u64,
    /// Places that differ.
    pub differing: u64,
    /// The first of them.
    pub first: Option<Difference>,
    /// Where they lie: `#` in the parts of the range that have some.
    #[serde(rename = "where")]
    pub overview: String,
}

/// A place at which the sides differ.
#[derive(Clone, Debug, Serialize)]
pub struct Difference {
    /// Number of the comparison, from 0.
    #[serde(skip)]
    pub order: u64,
    /// Window.
    pub window: usize,
    /// Place in each side: a tick or a sample.
    pub at: [u64; 2],
    /// What the first side has.
    pub expected: String,
    /// What the second side has.
    pub got: String,
    /// Bits that differ, if all are known.
    pub bits: Vec<u32>,
}

impl Comparison {
    /// Of two sources, with nothing found yet.
    pub(super) fn new(sources: [&Source; 2], unit: &'static str, alignment: String) -> Self {
        let sides = sources.map(Described::new);
        Comparison { sides, unit, alignment, ..Comparison::default() }
    }

    /// Whether the sides are the same.
    pub fn is_same(&self) -> bool {
        self.differences.is_empty()
            && self.pairs.iter().all(|pair| pair.differing == 0)
            && self.beats.as_ref().is_none_or(Beats::is_same)
    }

    /// Whether the signals of a side without a partner are listed: those of a capture, and those of
    /// a waveform that is compared with another.
    pub fn lists_unmatched(&self, side: usize) -> bool {
        self.sides[side].axis == Axis::Samples || self.sides[1 - side].axis != Axis::Samples
    }

    /// The pairs that differ, the earliest first.
    pub fn differing(&self) -> impl Iterator<Item = &Compared> {
        self.pairs.iter().filter(|pair| pair.differing > 0)
    }
}
