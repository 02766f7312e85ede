//! Result of a comparison of beats.

use serde::Serialize;
use strum::Display;

/// Number of differences that are listed individually.
const LISTED: usize = 64;

/// Result of a comparison of beats.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Beats {
    /// Signals of a word, by their names on the first side.
    pub signals: Vec<String>,
    /// Number of beats of each side.
    pub counts: [u64; 2],
    /// Number of equal beats.
    pub same: u64,
    /// Number of words of the first side that the second lacks.
    pub lost: u64,
    /// Number of words that the second side repeats.
    pub repeated: u64,
    /// Number of other words that only the second side has.
    pub extra: u64,
    /// Number of words with another value on the second side.
    pub changed: u64,
    /// Number of beats of each side before the first or after the last equal beat, which do not count as differences.
    pub outside: [u64; 2],
    /// First differences.
    pub list: Vec<BeatDifference>,
}

impl Beats {
    /// Returns whether there are no differences.
    pub fn is_same(&self) -> bool {
        self.differing() == 0
    }

    /// Returns the number of words that differ.
    pub fn differing(&self) -> u64 {
        self.lost + self.repeated + self.extra + self.changed
    }

    pub(crate) fn push(&mut self, difference: BeatDifference) {
        let count = match difference.kind {
            BeatKind::Lost => &mut self.lost,
            BeatKind::Repeated => &mut self.repeated,
            BeatKind::Extra => &mut self.extra,
            BeatKind::Changed => &mut self.changed,
        };
        *count += 1;
        if self.list.len() < LISTED {
            self.list.push(difference);
        }
    }
}

/// Kind of difference between beats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Display, Serialize)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum BeatKind {
    /// Only the first side has the word.
    Lost,
    /// The second side repeats the word.
    Repeated,
    /// Only the second side has the word.
    Extra,
    /// The word has another value.
    Changed,
}

/// A difference between beats.
#[derive(Clone, Debug, Serialize)]
pub struct BeatDifference {
    /// Kind of difference.
    pub kind: BeatKind,
    /// Number of the window.
    pub window: usize,
    /// The beat on each side, or the next one if a side lacks it.
    pub beats: [Option<BeatPlace>; 2],
    /// Word of the first side.
    pub expected: Option<String>,
    /// Word of the second side.
    pub got: Option<String>,
}

/// Position of a beat.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BeatPlace {
    /// Number of the beat.
    pub beat: u64,
    /// Number of the sample.
    pub sample: u64,
    /// Place in the source: a tick or a sample.
    pub at: u64,
}
