//! Result of a comparison.

mod beats;

use serde::Serialize;

use crate::source::{Axis, Source};

use super::matching::Unmatched;
use super::pair::MatchedBy;

pub use beats::{BeatDifference, BeatKind, BeatPlace, Beats};

/// Result of a comparison.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    /// Names and formats of the two sides.
    pub sides: [Described; 2],
    /// Unit that is compared: `changes` or `samples`.
    pub unit: &'static str,
    /// Description of the alignment.
    pub alignment: String,
    /// Delay of the second side, if it is constant [samples].
    pub offset: Option<i64>,
    /// Number of places compared.
    pub compared: u64,
    /// Result of each pair: the first to differ first, then in the order of the data flow.
    pub pairs: Vec<Compared>,
    /// Signals without a partner.
    pub unmatched: Vec<Unmatched>,
    /// Differences other than those of a signal's values.
    pub differences: Vec<String>,
    /// Diagnoses of the differences.
    pub findings: Vec<Finding>,
    /// Result for accepted words, if these are compared.
    pub beats: Option<Beats>,
    /// Values that could not be compared, each with the reason.
    pub skipped: Vec<String>,
    /// Notes for the user.
    pub notes: Vec<String>,
}

/// A diagnosis of some differences.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// Kind, as a word.
    pub kind: &'static str,
    /// Description, as a sentence.
    pub text: String,
    /// Signals whose differences it explains, by their names on the first side.
    pub signals: Vec<String>,
}

impl Finding {
    pub(super) fn new(kind: &'static str, signals: &[&str], text: String) -> Self {
        Finding { kind, text, signals: signals.iter().map(|&name| name.to_owned()).collect() }
    }
}

/// Description of a side.
#[derive(Clone, Debug, Default)]
pub struct Described {
    /// Path or scenario.
    pub name: String,
    /// Format.
    pub format: &'static str,
    /// Unit of its places.
    pub axis: Axis,
}

impl Described {
    pub(super) fn new(source: &Source) -> Self {
        let (name, format) = (source.name.clone(), source.format.into());
        Described { name, format, axis: source.axis }
    }

    /// Formats a place of the side.
    pub fn place(&self, at: u64) -> String {
        self.axis.place_text(at)
    }

    /// Returns a place of the side as a number: picoseconds, or a sample number.
    pub fn number(&self, at: u64) -> f64 {
        self.axis.place_number(at)
    }
}

/// Result of one pair.
#[derive(Clone, Debug, Serialize)]
pub struct Compared {
    /// Name on the first side.
    pub name: String,
    /// Name on the second side.
    pub other: String,
    /// Rule by which the signals were matched.
    #[serde(rename = "matched_by")]
    pub how: MatchedBy,
    /// Number of further names of the same signals.
    pub aliases: usize,
    /// Width [bits].
    pub width: u32,
    /// Number of places compared.
    pub compared: u64,
    /// Number of places that differ.
    pub differing: u64,
    /// First difference.
    pub first: Option<Difference>,
    /// Overview of the range: `#` for parts with differences, `.` for others.
    #[serde(rename = "where")]
    pub overview: String,
}

/// A difference of a pair.
#[derive(Clone, Debug, Serialize)]
pub struct Difference {
    /// Sequence number of the comparison, from 0.
    #[serde(skip)]
    pub order: u64,
    /// Number of the window.
    pub window: usize,
    /// Place on each side: a tick or a sample.
    pub at: [u64; 2],
    /// Value of the first side.
    pub expected: String,
    /// Value of the second side.
    pub got: String,
    /// Bits that differ, if all are known.
    pub bits: Vec<u32>,
}

impl Comparison {
    /// Creates an empty result.
    pub(super) fn new(sources: [&Source; 2], unit: &'static str, alignment: String) -> Self {
        let sides = sources.map(Described::new);
        Comparison { sides, unit, alignment, ..Comparison::default() }
    }

    /// Returns whether the sides are equal.
    pub fn is_same(&self) -> bool {
        self.differences.is_empty()
            && self.pairs.iter().all(|pair| pair.differing == 0)
            && self.beats.as_ref().is_none_or(Beats::is_same)
    }

    /// Returns whether unmatched signals of a side are listed: those of a capture, and those of a waveform that is
    /// compared with another.
    pub fn lists_unmatched(&self, side: usize) -> bool {
        self.sides[side].axis == Axis::Samples || self.sides[1 - side].axis != Axis::Samples
    }

    /// Returns the pairs that differ, in order of their first difference.
    pub fn differing(&self) -> impl Iterator<Item = &Compared> {
        self.pairs.iter().filter(|pair| pair.differing > 0)
    }
}
