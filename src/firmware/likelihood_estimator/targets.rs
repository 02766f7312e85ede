//! How many targets the estimator finds, and which of two it reports first.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Deviations of the pulse between two targets that are accepted: 11/4, in 16ths of a unit for each unit of a deviation.
pub const LEAST_APART: i64 = 44;
/// As near is a second echo that has moved the first, four deviations.
pub const NEAR: i64 = 64;
/// Drop of chi-square by which a histogram has two echoes: 36, as for another echo outside of a fit [8 fraction bits].
pub const LEAST_DROP: i64 = 36 << 8;
/// Drop of chi-square by which one echo may be two that are near each other [8 fraction bits].
pub const HINT: i64 = 14 << 8;
/// Steps of either echo in turn.
pub const TURNS: usize = 10;

/// Target that is reported first, of two.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// The nearer one.
    #[default]
    Nearest,
    /// The one with more signal.
    Strongest,
}

/// Targets that are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Targets {
    /// One.
    #[default]
    One,
    /// One or two, of which the nearer comes first.
    NearestFirst,
    /// One or two, of which the stronger comes first.
    StrongestFirst,
}

impl Targets {
    /// Returns up to so many, in that order.
    pub fn of(most: u32, order: Order) -> Self {
        match (most, order) {
            (..=1, _) => Targets::One,
            (_, Order::Nearest) => Targets::NearestFirst,
            (_, Order::Strongest) => Targets::StrongestFirst,
        }
    }

    /// Returns whether a second one is looked for.
    pub fn has_second(self) -> bool {
        self != Targets::One
    }

    /// Returns how many are found at most.
    pub fn most(self) -> u32 {
        1 + u32::from(self.has_second())
    }
}
