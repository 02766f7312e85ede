//! Matched signals, and the reasons why others have no partner.

use tofsim::error::{Input, Result};

use crate::source::{Name, Signal};

use super::super::find::near;
use super::super::pair::Pair;
use super::super::parts::Slots;

/// Test of whether the values of two signals can be compared.
pub(super) type Fits = fn(&Signal, &Signal) -> bool;

/// A signal without a partner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unmatched {
    /// Side: 0 for the first, 1 for the second.
    pub side: usize,
    /// Its name.
    pub name: String,
    /// Index in the source.
    pub(crate) signal: usize,
    /// Reason why it has no partner.
    pub reason: UnmatchedReason,
}

/// Reason why a signal has no partner.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UnmatchedReason {
    /// The other side has no signal of that name.
    #[error("no signal of that name on the other side")]
    Alone,
    /// The other side has several signals of that name.
    #[error("several on the other side: {}", .0.join(", "))]
    Ambiguous(Vec<String>),
    /// The signal of the other side has another width.
    #[error("{0} bits here, {1} on the other side")]
    Width(u32, u32),
    /// The other side has slices of the signal, but not all of its bits.
    #[error("{0} of its bits are not on the other side")]
    Part(u32),
    /// One side has words, whose values are not known.
    #[error("words on one side only")]
    Text,
    /// The signal of the other side has another type of values.
    #[error("{0} here, {1} on the other side")]
    Type(&'static str, &'static str),
    /// The user excluded the signal.
    #[error("left out")]
    Ignored,
}

impl UnmatchedReason {
    /// Returns whether the other side has the signal, so that its values should have been compared.
    pub fn is_skipped(&self) -> bool {
        !matches!(self, UnmatchedReason::Alone | UnmatchedReason::Ignored)
    }
}

/// Matched and unmatched signals.
#[derive(Clone, Debug, Default)]
pub(crate) struct Matching {
    pub(crate) pairs: Vec<Pair>,
    pub(crate) unmatched: Vec<Unmatched>,
    /// Signals to read from each side.
    pub(crate) slots: [Slots; 2],
    /// Whether the sides of the map are swapped.
    pub(crate) swapped: bool,
}

impl Matching {
    /// Returns the index of the pair that `text` names.
    ///
    /// # Errors
    /// If there is none, or several.
    pub(crate) fn pair(&self, text: &str) -> Result<usize> {
        let wanted = Name::new(text);
        let named = |name: &String| Name::new(name.clone()).common(&wanted) == Some(wanted.depth());
        let found: Vec<usize> = (self.pairs.iter().enumerate())
            .filter(|(_, pair)| named(&pair.name) || named(&pair.other))
            .map(|(k, _)| k)
            .collect();
        let fault = |expected: String| Input::new("compared signals", expected).field(text);
        match found[..] {
            [pair] => Ok(pair),
            [] => {
                let names = self.pairs.iter().map(|pair| pair.name.as_str());
                Err(fault(format!("no such signal{}", near(text, names))).into())
            }
            _ => {
                let names: Vec<_> =
                    found.iter().take(4).map(|&k| self.pairs[k].name.as_str()).collect();
                Err(fault(format!("several are called so: {}", names.join(", "))).into())
            }
        }
    }
}
