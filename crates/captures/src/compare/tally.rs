//! What is counted of each pair: samples compared, samples that differ, the first of them, and
//! where they lie.

use super::strip::Strip;

/// A place in both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Spot {
    /// Number of the comparison, from 0.
    pub(super) order: u64,
    /// Window.
    pub(super) piece: usize,
    /// Place in each source: a tick or a row.
    pub(super) at: [u64; 2],
}

/// The first difference of a pair.
#[derive(Clone, Debug)]
pub(super) struct First {
    pub(super) spot: Spot,
    pub(super) expected: String,
    pub(super) got: String,
    /// Bits that differ, if none of them is unknown.
    pub(super) bits: Vec<u32>,
}

/// What is counted of a pair.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    pub(super) compared: u64,
    pub(super) differing: u64,
    pub(super) first: Option<First>,
    pub(super) strip: Strip,
}

impl Tally {
    /// The pair differs at a place; `first` describes it.
    pub(super) fn differs(&mut self, place: u64, first: impl FnOnce() -> First) {
        self.differing += 1;
        self.strip.mark(place);
        if self.first.is_none() {
            self.first = Some(first());
        }
    }
}
