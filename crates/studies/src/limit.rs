//! Limits on a column, such as `peak.failure_rate < 0.1`.

use std::fmt;

use tofsim::error::{Result, hint};
use tofsim::files::toml::Checked;

use crate::columns::Column;

/// A limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Name of the column.
    pub column: String,
    /// Relation of the value to the number.
    pub relation: Relation,
    /// Number, in the column's unit.
    pub number: f64,
}

/// Relation of a value to a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// Less than.
    Below,
    /// Less than or equal to.
    AtMost,
    /// Greater than.
    Above,
    /// Greater than or equal to.
    AtLeast,
}

/// Operators of the relations, longer ones first.
const RELATIONS: [(&str, Relation); 4] = [
    ("<=", Relation::AtMost),
    (">=", Relation::AtLeast),
    ("<", Relation::Below),
    (">", Relation::Above),
];

impl Relation {
    /// Splits a text at its relation: what stands before it, the relation, and what stands after it.
    pub fn split(text: &str) -> Option<(&str, Relation, &str)> {
        RELATIONS.iter().find_map(|(sign, relation)| {
            let (left, right) = text.split_once(sign)?;
            Some((left.trim(), *relation, right.trim()))
        })
    }

    /// Returns whether the left number lies so to the right one.
    pub fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Relation::Below => left < right,
            Relation::AtMost => left <= right,
            Relation::Above => left > right,
            Relation::AtLeast => left >= right,
        }
    }
}

impl Limit {
    /// Parses a limit at a key of a plan.
    ///
    /// # Errors
    /// If it is not a limit, or its column does not exist.
    pub fn parse(checked: &Checked, key: &str, text: &str, known: &[Column]) -> Result<Self> {
        let found = Relation::split(text)
            .and_then(|(column, relation, number)| Some((column, relation, number.parse().ok()?)));
        let number = |(_, _, number): &(&str, Relation, f64)| number.is_finite();
        let Some((column, relation, number)) = found.filter(number) else {
            let expected =
                "expected a column, <, <=, > or >=, and a number, such as peak.failure_rate < 0.1";
            return Err(checked.fault(key, expected).into());
        };
        if !known.iter().any(|other| other.name == column) {
            let (hint, known) = hint(column, known.iter().map(|column| column.name.as_str()));
            let expected = format!("no column `{column}`{hint}; expected one of {known}");
            return Err(checked.fault(key, expected).into());
        }
        Ok(Limit { column: column.to_owned(), relation, number })
    }

    /// Returns whether a value meets the limit; a missing value does not.
    pub fn is_met(&self, value: Option<f64>) -> bool {
        value.is_some_and(|value| self.relation.holds(value, self.number))
    }

    /// Returns how close a value is to violating the limit, larger being worse: the used fraction of the limit, or
    /// the distance if the limit is 0; infinite without a value.
    pub fn use_of(&self, value: Option<f64>) -> f64 {
        let Some(value) = value else { return f64::INFINITY };
        let is_upper = matches!(self.relation, Relation::Below | Relation::AtMost);
        match (is_upper, self.number != 0.0) {
            (true, true) => value / self.number,
            (true, false) => value,
            (false, true) => self.number / value,
            (false, false) => -value,
        }
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = RELATIONS.iter().find(|(_, relation)| *relation == self.relation);
        let sign = sign.map_or("", |(sign, _)| sign);
        write!(f, "{} {sign} {}", self.column, self.number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_met_as_its_sign_says_and_never_without_a_value() {
        for (relation, at_1, at_2, at_3) in [
            (Relation::Below, true, false, false),
            (Relation::AtMost, true, true, false),
            (Relation::Above, false, false, true),
            (Relation::AtLeast, false, true, true),
        ] {
            let limit = Limit { column: "c".to_owned(), relation, number: 2.0 };
            let met = [1.0, 2.0, 3.0].map(|value| limit.is_met(Some(value)));
            assert_eq!(met, [at_1, at_2, at_3], "{limit}");
            assert!(!limit.is_met(None) && limit.use_of(None) > 1e9);
        }
    }

    #[test]
    fn use_grows_towards_the_limit() {
        let limit = |relation, number| Limit { column: "c".to_owned(), relation, number };
        assert_eq!(limit(Relation::AtMost, 4.0).use_of(Some(1.0)), 0.25);
        assert_eq!(limit(Relation::AtLeast, 4.0).use_of(Some(16.0)), 0.25);
        assert!(limit(Relation::AtLeast, 0.0).use_of(Some(1.0)) < 0.0);
    }
}
