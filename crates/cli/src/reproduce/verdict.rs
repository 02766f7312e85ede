//! Comparison of the thesis's value with ours, by a stated rule.

use serde::Serialize;

/// Verdict of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Equal, or no further apart than the thesis rounds and chance explains.
    Same,
    Differs,
    /// There is nothing that could be made again.
    CannotBeReproduced,
}

impl Verdict {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Verdict::Same => "same",
            Verdict::Differs => "differs",
            Verdict::CannotBeReproduced => "cannot be reproduced",
        }
    }

    /// Its class on a page.
    pub fn class(self) -> &'static str {
        match self {
            Verdict::Same => "same",
            Verdict::Differs => "differs",
            Verdict::CannotBeReproduced => "irreproducible",
        }
    }
}

/// The rule, in a sentence.
pub const RULE: &str = "A number is the same if it is equal, or no further from the thesis's than half a unit of the \
     last digit that the thesis prints and twice the standard errors of both, added as variances.";

/// A number, how many digits after the point are said of it, and its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Number {
    pub value: f64,
    #[serde(skip)]
    pub decimals: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standard_error: Option<f64>,
}

impl Number {
    pub fn new(value: f64, decimals: usize) -> Self {
        Number { value, decimals, standard_error: None }
    }

    /// The same with a standard error.
    pub fn with_error(self, standard_error: f64) -> Self {
        Number { standard_error: Some(standard_error), ..self }
    }

    /// As it is written.
    pub fn words(&self) -> String {
        let Number { value, decimals, .. } = *self;
        let value = format!("{value:.decimals$}");
        let value = if value.trim_start_matches(['-', '0', '.']).is_empty() {
            value.trim_start_matches('-').to_owned()
        } else {
            value
        };
        match self.standard_error {
            Some(error) => format!("{value} +- {error:.0$}", decimals + 1),
            None => value,
        }
    }
}

/// One side of a row.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Side {
    Number(Number),
    Words(String),
}

impl Side {
    pub fn words(&self) -> String {
        match self {
            Side::Number(number) => number.words(),
            Side::Words(words) => words.clone(),
        }
    }
}

/// Something that the thesis says, beside what comes out here.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    pub what: String,
    pub unit: &'static str,
    /// As printed; null where the thesis prints nothing.
    pub thesis: Option<Side>,
    pub ours: Side,
    /// Null where there is nothing to compare.
    pub verdict: Option<Verdict>,
}

impl Row {
    /// Two numbers, by the [`RULE`]; the decimals of the thesis's are those that it prints.
    pub fn numbers(
        what: impl Into<String>,
        unit: &'static str,
        thesis: Number,
        ours: Number,
    ) -> Self {
        let verdict = if is_same(&thesis, &ours) { Verdict::Same } else { Verdict::Differs };
        let (thesis, ours) = (Some(Side::Number(thesis)), Side::Number(ours));
        Row { what: what.into(), unit, thesis, ours, verdict: Some(verdict) }
    }

    /// Words that have to be equal.
    pub fn words(
        what: impl Into<String>,
        thesis: impl Into<String>,
        ours: impl Into<String>,
    ) -> Self {
        let (thesis, ours) = (thesis.into(), ours.into());
        let verdict = if thesis == ours { Verdict::Same } else { Verdict::Differs };
        let (thesis, ours) = (Some(Side::Words(thesis)), Side::Words(ours));
        Row { what: what.into(), unit: "", thesis, ours, verdict: Some(verdict) }
    }

    /// Something that the thesis says holds, whether it does here, and by what one sees that.
    pub fn claim(what: impl Into<String>, holds: bool, seen: impl Into<String>) -> Self {
        let verdict = Some(if holds { Verdict::Same } else { Verdict::Differs });
        let (thesis, ours) = (Some(Side::Words("so it says".to_owned())), Side::Words(seen.into()));
        Row { what: what.into(), unit: "", thesis, ours, verdict }
    }

    /// Something that the thesis does not print.
    pub fn ours_alone(what: impl Into<String>, unit: &'static str, ours: Number) -> Self {
        Row { what: what.into(), unit, thesis: None, ours: Side::Number(ours), verdict: None }
    }
}

/// The [`RULE`].
fn is_same(thesis: &Number, ours: &Number) -> bool {
    let rounding = 0.5 * 10f64.powi(-(thesis.decimals as i32));
    let errors = [thesis, ours].map(|number| number.standard_error.unwrap_or(0.0));
    let chance = 2.0 * errors.iter().map(|error| error * error).sum::<f64>().sqrt();
    (thesis.value - ours.value).abs() <= (rounding + chance) * (1.0 + 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(thesis: Number, ours: Number) -> Option<Verdict> {
        Row::numbers("", "", thesis, ours).verdict
    }

    #[test]
    fn rounding_and_two_standard_errors_of_both_are_no_difference() {
        let thesis = Number::new(12.77, 2);
        assert_eq!(verdict(thesis, Number::new(12.774, 3)), Some(Verdict::Same));
        assert_eq!(verdict(thesis, Number::new(12.776, 3)), Some(Verdict::Differs));
        assert_eq!(verdict(thesis, Number::new(12.80, 2).with_error(0.01)), Some(Verdict::Differs));
        let both = verdict(thesis.with_error(0.01), Number::new(12.80, 2).with_error(0.01));
        assert_eq!(both, Some(Verdict::Same));
    }

    #[test]
    fn whole_numbers_have_no_room_beside_half_a_unit() {
        let seven = Number::new(7.0, 0);
        assert_eq!(verdict(seven, Number::new(7.0, 0)), Some(Verdict::Same));
        assert_eq!(verdict(seven, Number::new(6.0, 0)), Some(Verdict::Differs));
    }

    #[test]
    fn words_are_the_same_or_not() {
        assert_eq!(Row::words("a", "01", "01").verdict, Some(Verdict::Same));
        assert_eq!(Row::words("a", "01", "1").verdict, Some(Verdict::Differs));
        assert_eq!(Row::ours_alone("a", "", Number::new(1.0, 0)).verdict, None);
    }

    #[test]
    fn a_number_is_written_with_its_standard_error_and_without_a_minus_at_nothing() {
        assert_eq!(Number::new(-5.66, 1).with_error(0.06).words(), "-5.7 +- 0.06");
        assert_eq!(Number::new(-0.04, 1).words(), "0.0");
    }
}
