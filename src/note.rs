//! Notes on a result: limits of the model, the training or the checks that it exceeds.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::error::short_number;

/// Kind of limit that a result exceeds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum NoteCode {
    /// The scenario lies outside the network's training domain.
    OutsideTraining,
    /// The echo arrives after the last bin.
    EchoPastHistogram,
    /// No laser light returns, or none is simulated.
    NoLight,
    /// The scenario violates an assumption of the estimator.
    EstimatorOutsideModel,
    /// The chain has drifted since the TDC was calibrated.
    ChainDrifted,
    /// The ring that calibrates the TDC is synchronous with its clock.
    RingInStep,
    /// The laser exceeds an eye-safety limit, or no limit is known.
    EyeSafety,
    /// The run ended before all of an input was used.
    UnusedInput,
    /// Two estimators disagree on the histogram of a frame, or the second one has no valid result.
    SecondOpinion,
    /// A model does not describe the data to which it was fitted.
    DoubtfulFit,
    /// The light of a cover window differs from its calibration.
    PedestalMoved,
    /// A measurement is uncertain because it has too few hits.
    FewHits,
    /// Two files could not be read or matched as they are.
    Comparison,
    /// A scenario key was given by its former name.
    RenamedKey,
    /// Nothing drives an input of a design under test.
    OpenInput,
}

impl fmt::Display for NoteCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.serialize(f)
    }
}

/// One limit that a result exceeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Note {
    /// Kind of limit.
    pub code: NoteCode,
    /// Scenario key or option that is the cause.
    pub key: String,
    /// Value of the key.
    pub value: NoteValue,
    /// Expected value of the key.
    pub expected: String,
    /// Explanation, as a sentence.
    pub text: String,
}

/// A value as a note shows it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum NoteValue {
    /// No value.
    None,
    /// A number, in the unit of the key.
    Number(f64),
    /// A switch.
    Flag(bool),
    /// A word or a name.
    Text(String),
}

impl Note {
    /// Creates a note that `key` has `value` where `expected` was expected; `text` explains the consequence.
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

/// Formats the line that a user sees.
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
            NoteValue::Number(number) => f.write_str(&short_number(&number.to_string())),
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

/// Returns the notes of several pixels, each cause once, with the number of pixels that have it.
pub fn merged<'a>(pixels: impl ExactSizeIterator<Item = &'a [Note]>) -> Vec<Note> {
    let count = pixels.len();
    let mut merged: Vec<(Note, usize)> = Vec::new();
    for note in pixels.flatten() {
        match merged.iter_mut().find(|(one, _)| one.code == note.code && one.key == note.key) {
            Some((_, having)) => *having += 1,
            None => merged.push((note.clone(), 1)),
        }
    }
    let counted = |(note, having): (Note, usize)| match having == count {
        true => note,
        false => {
            let text = format!("{}, and so at {having} of {count} pixels", note.text);
            Note { text, ..note }
        }
    };
    merged.into_iter().map(counted).collect()
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
