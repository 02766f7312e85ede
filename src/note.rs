//! What a result does not say by itself: where it lies outside of what was modelled, trained or checked.

use std::fmt;

use serde::{Deserialize, Serialize};

/// What kind of a limit a result is outside of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum NoteCode {
    /// The scenario is not what the network was trained for.
    OutsideTraining,
    /// The echo arrives after the last bin.
    EchoPastHistogram,
    /// No light of the laser comes back, or none is simulated.
    NoLight,
    /// An estimator takes for granted what the scenario does not have.
    EstimatorOutsideModel,
    /// The chain is not as it was when the TDC was calibrated.
    ChainDrifted,
    /// The ring that calibrates the TDC keeps step with its clock.
    RingInStep,
    /// The laser is above a limit, or there is none to tell.
    EyeSafety,
    /// The run ended before all of an input came due.
    UnusedInput,
    /// Two estimators part over the histogram of a frame, or the second one has nothing to say of it.
    SecondOpinion,
    /// A model does not describe what it was fitted to.
    DoubtfulFit,
    /// What was measured comes of too few hits to be known well.
    FewHits,
    /// Two files could not be read or matched as they are.
    Comparison,
}

impl fmt::Display for NoteCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.serialize(f)
    }
}

/// One limit that a result is outside of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Note {
    /// What kind of a limit.
    pub code: NoteCode,
    /// Key of the scenario, or option, that is the cause.
    pub key: String,
    /// What it is.
    pub value: NoteValue,
    /// What it would have to be.
    pub expected: String,
    /// All of it as a sentence.
    pub text: String,
}

/// A value as a note shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum NoteValue {
    /// There is none.
    None,
    /// A number, in the unit of the key.
    Number(f64),
    /// A switch.
    Flag(bool),
    /// A word or a name.
    Text(String),
}

impl Note {
    /// That `key` is `value` where `expected` would have to be; `text` says what comes of it.
    pub fn new(
        code: NoteCode,
        key: impl Into<String>,
        value: impl Into<NoteValue>,
        expected: impl Into<String>,
        text: impl fmt::Display,
    ) -> Note {
        let (key, value, expected) = (key.into(), value.into(), expected.into());
        Note { code, key, value, expected, text: text.to_string() }
    }
}

/// The line that a user sees.
impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "note: {} = {}: {}", self.key, self.value, self.text)?;
        write!(f, " (expected {}) [{}]", self.expected, self.code)
    }
}

impl fmt::Display for NoteValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoteValue::None => f.write_str("none"),
            NoteValue::Number(number) => number.fmt(f),
            NoteValue::Flag(flag) => flag.fmt(f),
            NoteValue::Text(text) => f.write_str(text),
        }
    }
}

impl From<f64> for NoteValue {
    fn from(number: f64) -> Self {
        NoteValue::Number(number)
    }
}

impl From<u64> for NoteValue {
    fn from(number: u64) -> Self {
        NoteValue::Number(number as f64)
    }
}

impl From<bool> for NoteValue {
    fn from(flag: bool) -> Self {
        NoteValue::Flag(flag)
    }
}

impl From<&str> for NoteValue {
    fn from(text: &str) -> Self {
        NoteValue::Text(text.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_is_a_line_for_the_user_and_an_object_for_a_program() {
        let text = "the network was not trained for it";
        let note =
            Note::new(NoteCode::OutsideTraining, "target.distance_m", 0.65, "0.1 to 0.6", text);
        assert_eq!(
            note.to_string(),
            "note: target.distance_m = 0.65: the network was not trained for it \
             (expected 0.1 to 0.6) [outside-training]"
        );
        let json = serde_json::to_string(&note).unwrap();
        assert_eq!(
            json,
            "{\"code\":\"outside-training\",\"key\":\"target.distance_m\",\"value\":0.65,\
             \"expected\":\"0.1 to 0.6\",\"text\":\"the network was not trained for it\"}"
        );
    }
}
