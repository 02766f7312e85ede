//! Results of measurements: values by name, with the formulas and sentences of the item table that use them, and drawings.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value as Json;

use tofsim::error::{Input, Result, hint};
use tofsim_studies::limit::Relation;

use crate::page::plot::Layer;
use crate::page::trace::Trace;

/// A value that a measurement gives a name.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number, and its standard error if noise moves it.
    Number(f64, Option<f64>),
    /// A list of numbers, which only a sentence can show.
    List(Vec<f64>),
    /// Words.
    Words(String),
}

/// Values by name.
#[derive(Clone, Debug, Default)]
pub struct Values(BTreeMap<String, Value>);

impl Values {
    /// Every number and word of a structure, named by its dotted path.
    pub fn of(structure: &impl Serialize) -> Self {
        let mut values = Values::default();
        values.flatten(String::new(), &serde_json::to_value(structure).unwrap_or_default());
        values
    }

    fn flatten(&mut self, name: String, json: &Json) {
        match json {
            Json::Object(parts) => {
                for (key, part) in parts {
                    let dot = if name.is_empty() { "" } else { "." };
                    self.flatten(format!("{name}{dot}{key}"), part);
                }
            }
            Json::Number(number) => self.put(name, number.as_f64().unwrap_or(f64::NAN)),
            Json::String(words) => self.put_words(name, words),
            _ => (),
        }
    }

    /// Returns, for each wave, its number of `rises`, the instant of the first one (`first_ns`), and its `high` samples.
    pub fn of_trace(trace: &Trace) -> Self {
        let mut values = Values::default();
        for wave in &trace.waves {
            let (name, rises) = (&wave.name, trace.rises_ns(&wave.name));
            values.put(format!("{name}.rises"), rises.len() as f64);
            values.put(format!("{name}.first_ns"), rises.first().copied().unwrap_or(f64::NAN));
            values.put(format!("{name}.high"), trace.high(name) as f64);
        }
        values
    }

    /// Gives a value a name.
    pub fn put_value(&mut self, name: impl Into<String>, value: Value) {
        self.0.insert(name.into(), value);
    }

    /// Gives a number a name; a claim is 1 where it holds, and else 0.
    pub fn put(&mut self, name: impl Into<String>, number: f64) {
        self.put_value(name, Value::Number(number, None));
    }

    /// Gives a number with its standard error a name.
    pub fn put_figure(&mut self, name: impl Into<String>, (number, error): (f64, f64)) {
        self.put_value(name, Value::Number(number, Some(error)));
    }

    /// Gives words a name.
    pub fn put_words(&mut self, name: impl Into<String>, words: impl Into<String>) {
        self.put_value(name, Value::Words(words.into()));
    }

    /// Adds values under a prefix.
    pub fn put_all(&mut self, prefix: &str, values: Values) {
        self.0.extend(values.0.into_iter().map(|(name, value)| (format!("{prefix}{name}"), value)));
    }

    /// Returns whether there is a value of that name.
    pub fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// Returns the value of a name.
    ///
    /// # Errors
    /// When there is none.
    pub fn get(&self, name: &str) -> Result<&Value> {
        self.0.get(name).ok_or_else(|| {
            let (hint, known) = hint(name, self.0.keys().map(String::as_str));
            Input::new("value", format!("no such value{hint}; expected one of {known}"))
                .value(name)
                .into()
        })
    }

    /// Evaluates a formula: names and numbers between blanks, joined by `+ - * /`.
    ///
    /// # Errors
    /// When a name is unknown or no number, or an operator is none.
    pub fn number(&self, formula: &str) -> Result<f64> {
        let mut tokens = formula.split_whitespace();
        let mut sum = 0.0;
        let mut product = self.term(tokens.next())?;
        while let Some(operator) = tokens.next() {
            let term = self.term(tokens.next())?;
            match operator {
                "*" => product *= term,
                "/" => product /= term,
                "+" => (sum, product) = (sum + product, term),
                "-" => (sum, product) = (sum + product, -term),
                _ => return Err(Input::new("formula", "expected + - * /").value(formula).into()),
            }
        }
        Ok(sum + product)
    }

    fn term(&self, token: Option<&str>) -> Result<f64> {
        let token = token.unwrap_or_default();
        match token.parse() {
            Ok(number) => Ok(number),
            Err(_) => match self.get(token)? {
                Value::Number(number, _) => Ok(*number),
                _ => Err(Input::new("formula", "expected a number").value(token).into()),
            },
        }
    }

    /// Evaluates a formula, with the standard error of one that is a single name.
    ///
    /// # Errors
    /// As [`Values::number`].
    pub fn figure(&self, formula: &str) -> Result<(f64, Option<f64>)> {
        match self.0.get(formula) {
            Some(Value::Number(number, error)) => Ok((*number, *error)),
            _ => Ok((self.number(formula)?, None)),
        }
    }

    /// Evaluates a condition: two formulas with `<`, `<=`, `>` or `>=` between them, or one that must not be 0.
    ///
    /// # Errors
    /// As [`Values::number`].
    pub fn holds(&self, condition: &str) -> Result<bool> {
        match Relation::split(condition) {
            Some((left, relation, right)) => {
                Ok(relation.holds(self.number(left)?, self.number(right)?))
            }
            None => Ok(self.number(condition)? != 0.0),
        }
    }

    /// Fills a sentence: `{formula}`, or `{formula:.2}` with two decimals.
    ///
    /// # Errors
    /// When a brace is not closed, or as [`Values::number`].
    pub fn fill(&self, sentence: &str) -> Result<String> {
        let mut parts = sentence.split('{');
        let mut text = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let unclosed = || Input::new("sentence", "expected }").value(sentence);
            let (place, rest) = part.split_once('}').ok_or_else(unclosed)?;
            text += &self.shown(place)?;
            text += rest;
        }
        Ok(text)
    }

    fn shown(&self, place: &str) -> Result<String> {
        let (formula, decimals) = match place.split_once(":.") {
            Some((formula, decimals)) => (formula, decimals.parse().ok()),
            None => (place, None),
        };
        let number = |number: f64| match decimals {
            Some(decimals) => format!("{number:.decimals$}"),
            None => number.to_string(),
        };
        Ok(match self.0.get(formula) {
            Some(Value::Words(words)) => words.clone(),
            Some(Value::List(list)) => {
                list.iter().copied().map(number).collect::<Vec<_>>().join(", ")
            }
            _ => number(self.number(formula)?),
        })
    }
}

/// Result of an item's measurement: values by name, and pictures in the order of the item's.
#[derive(Default)]
pub struct Measured {
    /// Values that rows, pictures and the reason name.
    pub values: Values,
    /// Pictures without their words.
    pub drawings: Vec<Drawing>,
}

impl From<Values> for Measured {
    fn from(values: Values) -> Self {
        Measured { values, drawings: Vec::new() }
    }
}

impl Measured {
    /// Adds a plot.
    pub fn layers(mut self, layers: Vec<Layer>) -> Self {
        self.drawings.push(Drawing::Layers(layers));
        self
    }

    /// Adds a whole picture.
    pub fn svg(mut self, svg: String) -> Self {
        self.drawings.push(Drawing::Svg(svg));
        self
    }

    /// Adds a timing diagram.
    pub fn trace(mut self, trace: Trace) -> Self {
        self.drawings.push(Drawing::Trace(trace));
        self
    }
}

/// A picture without its words.
pub enum Drawing {
    /// Layers of a plot.
    Layers(Vec<Layer>),
    /// A whole picture, drawn for a wide page.
    Svg(String),
    /// A timing diagram.
    Trace(Trace),
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values() -> Values {
        let mut values = Values::default();
        values.put("a", 6.0);
        values.put_figure("b.c", (0.5, 0.1));
        values.put_value("all", Value::List(vec![1.0, 2.25]));
        values.put_words("word", "0f");
        values
    }

    #[test]
    fn products_come_before_sums() {
        let values = values();
        assert_eq!(values.number("a - 2 * b.c + 1").unwrap(), 6.0);
        assert_eq!(values.number("100 * b.c / a").unwrap(), 100.0 * 0.5 / 6.0);
        assert_eq!(values.figure("b.c").unwrap(), (0.5, Some(0.1)));
        assert_eq!(values.figure("b.c + 0").unwrap(), (0.5, None));
        for fault in ["d", "a +", "a ^ 2", "word", "all", ""] {
            assert!(values.number(fault).is_err(), "{fault}");
        }
    }

    #[test]
    fn conditions_compare_two_formulas() {
        let values = values();
        for (condition, holds) in
            [("a > 5", true), ("a + 1 <= 2 * b.c", false), ("a", true), ("a - 6", false)]
        {
            assert_eq!(values.holds(condition).unwrap(), holds, "{condition}");
        }
    }

    #[test]
    fn sentences_show_numbers_lists_and_words() {
        let filled = values().fill("{a}, {100 * b.c:.1} %: {all:.1}; {word}").unwrap();
        assert_eq!(filled, "6, 50.0 %: 1.0, 2.2; 0f");
        assert!(values().fill("{a").is_err() && values().fill("{none}").is_err());
    }

    #[test]
    fn a_structure_gives_its_paths() {
        let values = Values::of(&serde_json::json!({ "a": { "b": 2, "c": "x" }, "d": 0.1 }));
        assert_eq!(values.number("a.b").unwrap(), 2.0);
        assert_eq!(values.fill("{a.c} {d}").unwrap(), "x 0.1");
    }
}
