//! What a comparison of beats has found.

use serde::Serialize;

/// Differences that are listed one by one.
const LISTED: usize = 64;

/// What a comparison of beats has found.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Beats {
    /// Signals of a word, by their names on the first side.
    pub signals: Vec<String>,
    /// Beats of each side.
    pub counts: [u64; 2],
    /// Beats that are the same.
    pub same: u64,
    /// Words of the first side that the second has not.
    pub lost: u64,
    /// Words of the second side that it has once more.
    pub repeated: u64,
    /// Other words that the second side has more.
    pub extra: u64,
    /// Words that are others on the second side.
    pub changed: u64,
    /// Beats of each side before the first that is the same or after the last, which are no
    /// difference.
    pub outside: [u64; 2],
    /// The first differences.
    pub list: Vec<BeatDifference>,
}

impl Beats {
    /// Whether nothing differs.
    pub fn is_same(&self) -> bool {
        self.differing() == 0
    }

    /// How many words differ.
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

/// How a beat differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum BeatKind {
    /// The first side alone has it.
    Lost,
    /// The second side has it once more than the first.
    Repeated,
    /// The second side alone has it.
    Extra,
    /// It has another value.
    Changed,
}

impl BeatKind {
    /// In a word.
    pub const fn word(self) -> &'static str {
        match self {
            BeatKind::Lost => "lost",
            BeatKind::Repeated => "repeated",
            BeatKind::Extra => "extra",
            BeatKind::Changed => "changed",
        }
    }
}

/// A beat that differs.
#[derive(Clone, Debug, Serialize)]
pub struct BeatDifference {
    /// How.
    pub kind: BeatKind,
    /// Window.
    pub window: usize,
    /// The beat on each side, or the next one where a side has none.
    pub beats: [Option<BeatPlace>; 2],
    /// The word of the first side.
    pub expected: Option<String>,
    /// The word of the second side.
    pub got: Option<String>,
}

/// Where a beat is.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BeatPlace {
    /// Its number among the beats.
    pub beat: u64,
    /// Number of its sample.
    pub sample: u64,
    /// Its place in the source: a tick or a sample.
    pub at: u64,
}
