//! Status code of an estimate: in one word, what a host can rely on.

use serde::{Serialize, Serializer};

use crate::kernel::signals::Word;
use crate::states;

use super::status::{Status, StatusSet};

macro_rules! status_codes {
    ($($(#[doc = $meaning:literal])+ $Name:ident = $word:literal,)+) => {
        states! {
            /// What a host can rely on. If several reasons speak against a depth, the code is the first that applies in
            /// [`StatusCode::of`].
            pub enum StatusCode: 4 {
                $($(#[doc = $meaning])+ $Name,)+
            }
        }

        impl StatusCode {
            /// Every code, in the order of their numbers.
            pub const ALL: &[Self] = &[$(Self::$Name),+];

            /// Returns its name in results and messages.
            pub fn word(self) -> &'static str {
                match self {
                    $(Self::$Name => $word,)+
                }
            }

            /// Returns its meaning.
            pub fn meaning(self) -> &'static str {
                match self {
                    $(Self::$Name => concat!($($meaning),+).trim_ascii(),)+
                }
            }
        }
    };
}

status_codes! {
    /// The estimator states no status.
    Unstated = "not stated",
    /// The depth is valid.
    Valid = "valid",
    /// The depth is valid, and there is a second target.
    ValidSecond = "valid, second target present",
    /// Nothing stands out of the background.
    NoTarget = "no target",
    /// Nothing stands out, and background light has used up nearly all shots before the end of the window.
    AmbientTooHigh = "ambient too high",
    /// An end of the window cuts the pulse.
    CutOff = "cut off by the window",
    /// Hardly a shot was left when the echo came.
    Saturated = "saturated",
    /// The light of the cover glass is no longer what was calibrated.
    PedestalChanged = "pedestal changed",
    /// Another echo stands out, of which no depth is reported.
    AnotherEcho = "another echo",
    /// The iteration has not come to rest.
    NotSettled = "not settled",
    /// The histogram differs from the model.
    NoFit = "no fit",
    /// Some shots were not armed at the laser edge (MODE 1).
    NotArmed = "shots not armed",
}

/// Conditions that the code depends on beside the reasons of the status.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CodeConditions {
    /// Less than a 64th of the shots are left at the end of the window.
    pub is_blind: bool,
    /// The light of the cover glass is less than half or more than twice what was calibrated.
    pub has_changed: bool,
    /// A second target is reported.
    pub has_second: bool,
}

impl StatusCode {
    /// Returns the code of an estimate of the firmware, the first that applies.
    pub fn of(status: StatusSet, conditions: CodeConditions) -> Self {
        let CodeConditions { is_blind, has_changed, has_second } = conditions;
        let (has, is_dark) = (|reason| status.contains(reason), status.contains(Status::NoEcho));
        let codes = [
            (has(Status::Unarmed), StatusCode::NotArmed),
            (has_changed, StatusCode::PedestalChanged),
            (is_dark && is_blind, StatusCode::AmbientTooHigh),
            (is_dark, StatusCode::NoTarget),
            (has(Status::UsedUp), StatusCode::Saturated),
            (has(Status::CutOff), StatusCode::CutOff),
            (has(Status::Another), StatusCode::AnotherEcho),
            (has(Status::NotSettled), StatusCode::NotSettled),
            (has(Status::NoFit), StatusCode::NoFit),
            (has_second, StatusCode::ValidSecond),
        ];
        let first = codes.into_iter().find(|(applies, _)| *applies);
        first.map_or(StatusCode::Valid, |(_, code)| code)
    }

    /// Returns whether the estimator states no status.
    pub fn is_unstated(&self) -> bool {
        *self == StatusCode::Unstated
    }

    /// Returns the code with a number; [`StatusCode::Unstated`] for a number that has none.
    pub fn of_number(number: u64) -> Self {
        Self::of_bits(number)
    }
}

impl Serialize for StatusCode {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.word().serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reason_against_a_depth_has_a_code_that_is_not_valid() {
        for &reason in &Status::ALL[..7] {
            let code = StatusCode::of(reason.into(), CodeConditions::default());
            let is_valid = [StatusCode::Unstated, StatusCode::Valid, StatusCode::ValidSecond];
            assert!(!is_valid.contains(&code), "{reason:?} {code:?}");
        }
    }

    #[test]
    fn a_second_target_accompanies_a_valid_depth_only() {
        let conditions = CodeConditions { has_second: true, ..CodeConditions::default() };
        assert_eq!(StatusCode::of(StatusSet::default(), conditions), StatusCode::ValidSecond);
        assert_eq!(StatusCode::of(Status::CutOff.into(), conditions), StatusCode::CutOff);
    }

    #[test]
    fn a_dark_window_is_blind_if_hardly_a_shot_is_left() {
        let conditions = CodeConditions { is_blind: true, ..CodeConditions::default() };
        let with = |reason: Status| StatusCode::of(reason.into(), conditions);
        assert_eq!(with(Status::NoEcho), StatusCode::AmbientTooHigh);
        assert_eq!(with(Status::CutOff), StatusCode::CutOff);
        assert_eq!(StatusCode::of(StatusSet::default(), conditions), StatusCode::Valid);
    }

    #[test]
    fn the_documented_table_has_every_code() {
        let model = include_str!("../../../docs/model.md");
        for (number, code) in StatusCode::ALL.iter().enumerate() {
            let row = format!("\n| {number} | `{code:?}` | {} | {} |", code.word(), code.meaning());
            assert!(model.contains(&row), "{row}");
            assert_eq!(StatusCode::of_number(number as u64), *code);
        }
    }
}
