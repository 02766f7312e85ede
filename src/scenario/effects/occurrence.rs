//! An effect that a scenario has.

use crate::note::NoteValue;
use crate::scenario::Scenario;

use super::key::Key;
use super::table::Effect;

/// An effect that a scenario has, with the key that switches it on.
#[derive(Clone, Debug, PartialEq)]
pub struct Occurrence {
    /// The effect.
    pub effect: Effect,
    /// The key's path.
    pub key: &'static str,
    /// The key's value.
    pub value: NoteValue,
    /// The value without the effect.
    usual: NoteValue,
    /// The largest value that is still accepted, where more than the usual one is [the key's unit].
    limit: f64,
}

impl Occurrence {
    pub(super) fn new(effect: Effect, key: &Key, scenario: &Scenario) -> Self {
        let (value, usual) = (key.value(scenario), key.usual());
        Occurrence { effect, key: key.name, value, usual, limit: 0.0 }
    }

    pub(super) fn within(self, limit: f64) -> Self {
        Occurrence { limit, ..self }
    }

    /// Whether the value is beyond what is accepted.
    pub(super) fn is_beyond(&self) -> bool {
        match self.value {
            NoteValue::Number(value) if self.limit > 0.0 => value > self.limit,
            _ => true,
        }
    }

    /// Returns the values that are accepted, in words.
    pub fn expected(&self) -> String {
        match self.limit {
            limit if limit > 0.0 => format!("{limit} at most"),
            _ => self.usual.to_string(),
        }
    }
}
