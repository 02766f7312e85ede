//! The values that a grid gives to a key of the scenario.

use std::fmt;

use serde::Serialize;
use toml_edit::Table;

use tofsim::error::{Error, Input, Result};
use tofsim::files::toml::assign;
use tofsim::scenario::Scenario;

use super::decimal::Decimal;

/// Most values of a key.
const MOST_VALUES: usize = 1_000_000;
/// Description of a grid's syntax.
const EXPECTED: &str = "expected FROM..TO:STEP or values with commas between them, such as \
    target.distance_m=0.05..1.5:0.05 or target.distance_m=0.1,0.2";

/// A key of the scenario and its values, in rising order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// The key, such as `target.distance_m`.
    pub key: String,
    /// The values as they were typed: `0.05..0.9:0.0025`, or with commas.
    #[serde(rename = "values")]
    pub text: String,
    /// Each value, the `f64` nearest to the decimal, in the key's unit.
    #[serde(skip)]
    pub values: Vec<f64>,
}

impl Axis {
    /// From the option `KEY=VALUES`; `source` is the option's name, or the file.
    ///
    /// # Errors
    /// When the scenario has no such key or no such value, or the values do not rise.
    pub fn parse(source: &str, option: &str) -> Result<Self> {
        let Some((key, text)) = option.split_once('=') else {
            return Err(Input::new(source, EXPECTED).value(option).into());
        };
        let (key, text) = (key.trim(), text.trim());
        let fault =
            |expected: &str| Error::from(Input::new(source, expected).field(key).value(text));
        let decimals = match text.split_once("..") {
            Some((first, rest)) => {
                let (last, step) = rest.split_once(':').ok_or_else(|| fault(EXPECTED))?;
                let parts = [first, last, step].map(Decimal::parse);
                let [Some(first), Some(last), Some(step)] = parts else {
                    return Err(fault(EXPECTED));
                };
                Decimal::steps(first, last, step, MOST_VALUES).ok_or_else(|| {
                    let most =
                        "expected FROM below TO, STEP above 0, and no more than 1000000 values";
                    fault(most)
                })?
            }
            None => {
                let values: Option<Vec<_>> = text.split(',').map(Decimal::parse).collect();
                values.ok_or_else(|| fault(EXPECTED))?
            }
        };
        if key == "seed" {
            return Err(fault("every row has random numbers of its own; see --seed and --repeats"));
        }
        for decimal in [decimals.first(), decimals.last()].into_iter().flatten() {
            check(source, key, decimal)?;
        }
        let values: Vec<_> = decimals.iter().map(|decimal| decimal.value()).collect();
        if !values.is_sorted_by(|a, b| a < b) {
            return Err(fault("expected rising values, each once"));
        }
        Ok(Axis { key: key.to_owned(), text: text.to_owned(), values })
    }

    /// One value alone.
    pub(super) fn single(key: &str, value: f64) -> Self {
        Axis { key: key.to_owned(), text: value.to_string(), values: vec![value] }
    }

    /// From a range that is known to be one.
    pub(super) fn steps(key: &str, first: u32, step: u32, count: u32, per_unit: u32) -> Self {
        let value = |k: u32| f64::from(first + k * step) / f64::from(per_unit);
        let last = value(count - 1);
        let text = format!("{}..{last}:{}", value(0), f64::from(step) / f64::from(per_unit));
        Axis { key: key.to_owned(), text, values: (0..count).map(value).collect() }
    }

    /// Number of values.
    pub fn count(&self) -> u64 {
        self.values.len() as u64
    }

    /// Least and largest value.
    pub fn range(&self) -> [f64; 2] {
        let least = self.values.first().copied().unwrap_or(f64::NAN);
        [least, self.values.last().copied().unwrap_or(f64::NAN)]
    }

    /// The value in the middle.
    pub fn middle(&self) -> f64 {
        self.values.get(self.values.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// With `most` of the values at most ([`thinned`]).
    pub fn thinned(&self, most: usize) -> Self {
        if self.values.len() <= most {
            return self.clone();
        }
        let values = thinned(&self.values, most);
        let text = values.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        Axis { key: self.key.clone(), text, values }
    }
}

/// `most` of the values at most, two at least, evenly far apart where that can be, the first and the last
/// among them.
pub fn thinned(values: &[f64], most: usize) -> Vec<f64> {
    let gaps = values.len().saturating_sub(1);
    let most = most.saturating_sub(1).max(1);
    if gaps <= most {
        return values.to_vec();
    }
    let even = (most.div_ceil(2)..=most).rev().find(|&parts| gaps.is_multiple_of(parts));
    let parts = even.unwrap_or(most);
    (0..=parts).map(|k| values[(k * gaps + parts / 2) / parts]).collect()
}

/// As the option has it.
impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key, self.text)
    }
}

/// Checks that the scenario has such a key and value.
fn check(source: &str, key: &str, value: &Decimal) -> Result<()> {
    assign::<Scenario>(&mut Table::new(), source, &format!("{key}={value}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(option: &str) -> Axis {
        Axis::parse("--grid", option).unwrap()
    }

    fn refused(option: &str) -> String {
        Axis::parse("--grid", option).unwrap_err().to_string()
    }

    #[test]
    fn every_value_is_the_decimal_that_a_user_would_type() {
        for (option, decimals) in [
            ("target.distance_m=0.05..0.9:0.0025", 4),
            ("target.reflectance=0.03..0.95:0.02", 2),
            ("ambient.irradiance_w_m2_nm=0..0.4:0.05", 2),
        ] {
            for value in axis(option).values {
                let typed: f64 = format!("{value:.decimals$}").parse().unwrap();
                assert_eq!(value, typed);
            }
        }
        assert_eq!(axis("target.distance_m=0.1, 0.25").values, [0.1, 0.25]);
        assert_eq!(axis("firmware.shots_per_frame=15000").values, [15_000.0]);
    }

    #[test]
    fn the_thesis_s_steps_are_what_a_range_of_them_is() {
        let steps = Axis::steps("target.distance_m", 1000, 25, 201, 10_000);
        assert_eq!(steps, axis("target.distance_m=0.1..0.6:0.0025"));
    }

    #[test]
    fn what_the_scenario_does_not_have_is_refused_by_its_own_schema() {
        let error = refused("target.distance_m=500..1001:500.5");
        let expected = "target.distance_m = 1000.5: expected a number from 0.001 to 1000.0 [m]";
        assert!(error.contains(expected), "{error}");
        assert!(refused("target.distance=0.5").contains("did you mean `distance_m`?"));
        assert!(refused("tdc.profile=1").contains("a text in quotes"));
        assert!(refused("firmware.shots_per_frame=1.5").contains("a whole number"));
        assert!(refused("seed=1,2").contains("--repeats"));
    }

    #[test]
    fn what_is_no_list_of_rising_numbers_is_refused() {
        let key = |values: &str| refused(&format!("target.distance_m={values}"));
        for values in ["", "a", "0.1,", "0.1..0.2", "0.1..:0.1", "nan", "0.1;0.2"] {
            assert!(key(values).contains("expected FROM..TO:STEP"), "{values}: {}", key(values));
        }
        for values in ["0.2,0.1", "0.1,0.1"] {
            assert!(key(values).contains("rising values, each once"));
        }
        for values in ["0.2..0.1:0.1", "0.1..0.2:0", "0.1..0.2:1e-12"] {
            assert!(key(values).contains("STEP above 0"), "{values}");
        }
        assert!(refused("thesi").contains("expected FROM..TO:STEP"));
    }

    #[test]
    fn thinning_keeps_both_ends_and_even_gaps() {
        let of = |option: &str, most| axis(option).thinned(most).values;
        let found = of("target.distance_m=0.05..0.9:0.0025", 51);
        assert_eq!((found.len(), found[0], found[1], found[34]), (35, 0.05, 0.075, 0.9));
        assert_eq!(of("target.distance_m=0.1..0.6:0.0025", 51).len(), 51);
        let odd = of("target.distance_m=0.1..0.63:0.01", 20);
        assert_eq!((odd.len(), odd[0], odd[19]), (20, 0.1, 0.63));
        assert_eq!(of("target.distance_m=0.1,0.3", 6), [0.1, 0.3]);
        assert_eq!(of("target.distance_m=0.1,0.2,0.3", 1), [0.1, 0.3]);
    }
}
