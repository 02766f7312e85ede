//! Candidates of an alignment.

/// Number of candidates that are kept.
pub const KEPT: usize = 8;

/// An offset with its number of differences.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Sample of the longer side that corresponds to the first of the shorter side.
    pub offset: i64,
    /// Number of bits that differ.
    pub differing: u64,
    /// Number of bits compared.
    pub compared: u64,
}

impl Candidate {
    /// Returns the delay of the second side, given that `side` is the shorter one [samples].
    pub fn later(&self, side: usize) -> i64 {
        if side == 0 { self.offset } else { -self.offset }
    }

    /// Returns the proportion of bits that differ.
    pub fn rate(&self) -> f64 {
        self.differing as f64 / self.compared.max(1) as f64
    }
}

/// Bits of some pairs at consecutive samples: 1, -1, or 0 if unknown.
pub type Rows = Vec<Vec<i8>>;
