//! Which signals came together, and why others did not.

use tofsim::error::{Input, Result};

use crate::source::Name;

use super::super::find::near;
use super::super::pair::Pair;
use super::super::parts::Slots;

/// A signal that has no partner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unmatched {
    /// 0 for the first side, 1 for the second.
    pub side: usize,
    /// Its name.
    pub name: String,
    /// Its index in the source.
    pub(crate) signal: usize,
    /// Why.
    pub reason: UnmatchedReason,
}

/// Why a signal has no partner.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UnmatchedReason {
    /// The other side has no signal of that name.
    #[error("no signal of that name on the other side")]
    Alone,
    /// The other side has several.
    #[error("several on the other side: {}", .0.join(", "))]
    Ambiguous(Vec<String>),
    /// The other side's has another width.
    #[error("{0} bits here, {1} on the other side")]
    Width(u32, u32),
    /// The other side has slices of it, but not so many of its bits.
    #[error("{0} of its bits are not on the other side")]
    Part(u32),
    /// It is text or an event, or its partner is.
    #[error("text on one side only, or an event")]
    Text,
    /// It was asked not to be compared.
    #[error("left out")]
    Ignored,
}

/// What came together, and what did not.
#[derive(Clone, Debug, Default)]
pub(crate) struct Matching {
    pub(crate) pairs: Vec<Pair>,
    pub(crate) unmatched: Vec<Unmatched>,
    /// Signals that each side has to read.
    pub(crate) slots: [Slots; 2],
    /// Whether the map has the sides the other way round.
    pub(crate) swapped: bool,
}

impl Matching {
    /// The pair that a user calls so.
    ///
    /// # Errors
    /// When there is none, or several.
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
