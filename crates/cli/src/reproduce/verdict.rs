//! Comparison of the thesis's value with ours, by a stated rule.

use serde::Serialize;
use strum::{IntoStaticStr, VariantArray};

/// Verdict of a comparison, in the order in which they are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, IntoStaticStr, VariantArray)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Verdict {
    /// Equal, or no further apart than the thesis rounds and chance explains.
    Same,
    Differs,
    /// Nothing differs, but a quick run has too few histograms to be sure.
    Undecided,
    /// The thesis says too little to make it again.
    CannotBeReproduced,
    /// It has no values, as a drawing.
    NothingToReproduce,
}

impl Verdict {
    fn of(is_same: bool) -> Self {
        if is_same { Verdict::Same } else { Verdict::Differs }
    }

    /// Returns its key in the JSON object.
    pub fn key(self) -> &'static str {
        self.into()
    }

    /// Returns it in words.
    pub fn words(self) -> String {
        self.key().replace('_', " ")
    }

    /// Its class on a page.
    pub fn class(self) -> &'static str {
        match self {
            Verdict::Same => "same",
            Verdict::Differs => "differs",
            Verdict::Undecided | Verdict::CannotBeReproduced | Verdict::NothingToReproduce => {
                "irreproducible"
            }
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
    pub unit: String,
    /// As printed; null where the thesis prints nothing.
    pub thesis: Option<Side>,
    pub ours: Side,
    /// Null where there is nothing to compare.
    pub verdict: Option<Verdict>,
}

impl Row {
    /// Compares both sides: numbers by the [`RULE`], words letter by letter. Where the thesis prints nothing there is no
    /// verdict.
    pub fn new(what: String, unit: &str, thesis: Option<Side>, ours: Side) -> Self {
        let is_same = thesis.as_ref().map(|thesis| match (thesis, &ours) {
            (Side::Number(thesis), Side::Number(ours)) => is_same(thesis, ours),
            _ => *thesis == ours,
        });
        Row { what, unit: unit.to_owned(), thesis, ours, verdict: is_same.map(Verdict::of) }
    }

    /// Withdraws the verdict that both sides are the same, because fewer histograms are kinder.
    pub fn leave_open(&mut self) {
        self.verdict = self.verdict.map(|verdict| match verdict {
            Verdict::Same => Verdict::Undecided,
            other => other,
        });
    }

    /// Returns what is compared, with its unit, and both sides as they are written.
    pub fn cells(&self) -> [String; 3] {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" [{}]", self.unit) };
        let thesis = self.thesis.as_ref().map_or("-".to_owned(), Side::words);
        [format!("{}{unit}", self.what), thesis, self.ours.words()]
    }

    /// Judges a claim: whether it holds here, and by what one sees that.
    pub fn claim(what: String, holds: bool, seen: String) -> Self {
        let (thesis, ours) = (Some(Side::Words("so it says".to_owned())), Side::Words(seen));
        Row { what, unit: String::new(), thesis, ours, verdict: Some(Verdict::of(holds)) }
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

    fn number(value: f64, decimals: usize, standard_error: Option<f64>) -> Number {
        Number { value, decimals, standard_error }
    }

    fn row(thesis: Option<Side>, ours: Side) -> Option<Verdict> {
        Row::new(String::new(), "", thesis, ours).verdict
    }

    fn verdict(thesis: Number, ours: Number) -> Option<Verdict> {
        row(Some(Side::Number(thesis)), Side::Number(ours))
    }

    #[test]
    fn rounding_and_two_standard_errors_of_both_are_no_difference() {
        let thesis = number(12.77, 2, None);
        assert_eq!(verdict(thesis, number(12.774, 3, None)), Some(Verdict::Same));
        assert_eq!(verdict(thesis, number(12.776, 3, None)), Some(Verdict::Differs));
        assert_eq!(verdict(thesis, number(12.80, 2, Some(0.01))), Some(Verdict::Differs));
        let both =
            verdict(Number { standard_error: Some(0.01), ..thesis }, number(12.80, 2, Some(0.01)));
        assert_eq!(both, Some(Verdict::Same));
    }

    #[test]
    fn whole_numbers_have_no_room_beside_half_a_unit() {
        let seven = number(7.0, 0, None);
        assert_eq!(verdict(seven, number(7.0, 0, None)), Some(Verdict::Same));
        assert_eq!(verdict(seven, number(6.0, 0, None)), Some(Verdict::Differs));
    }

    #[test]
    fn words_are_the_same_or_not() {
        let words = |text: &str| Side::Words(text.to_owned());
        assert_eq!(row(Some(words("01")), words("01")), Some(Verdict::Same));
        assert_eq!(row(Some(words("01")), words("1")), Some(Verdict::Differs));
        assert_eq!(row(None, words("1")), None);
    }

    #[test]
    fn a_number_is_written_with_its_standard_error_and_without_a_minus_at_nothing() {
        assert_eq!(number(-5.66, 1, Some(0.06)).words(), "-5.7 +- 0.06");
        assert_eq!(number(-0.04, 1, None).words(), "0.0");
    }
}
