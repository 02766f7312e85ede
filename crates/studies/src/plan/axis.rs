//! Axes of a plan: scenario keys with their values.

use toml_edit::Table;

use tofsim::error::{Input, Result};
use tofsim::files::toml::{Checked, assign};
use tofsim::kernel::pulse::normal_cdf;
use tofsim::scenario::Scenario;
use tofsim_learn::dataset;

use super::distribution::{Quantiles, between};
use super::fault::at_key;
use super::file::{AxisFile, Distribution, Scale, Value};

/// Largest number of values of an axis.
const MOST_VALUES: u64 = 10_000_000;

/// A key with its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The key, such as `target.distance_m`.
    pub key: String,
    /// Whether its values are words or switches rather than numbers.
    pub is_text: bool,
    values: Values,
    /// Whether the key accepts whole numbers only.
    is_whole: bool,
}

#[derive(Clone, Debug, PartialEq)]
enum Values {
    /// Listed values, as TOML.
    List(Vec<String>),
    /// Evenly spaced values between two numbers.
    Range { ends: [f64; 2], scale: Scale, count: Option<u64> },
    /// Random values.
    Drawn { quantiles: Quantiles, count: Option<u64> },
}

impl Axis {
    /// Checks the axes of a plan, which are located below the key `place`.
    ///
    /// # Errors
    /// If one is inconsistent, the scenario has no such key or value, or a key has two axes.
    pub fn all(checked: &Checked, place: &str, files: &[AxisFile]) -> Result<Vec<Axis>> {
        let axis =
            |(k, file): (usize, &AxisFile)| Axis::new(checked, &format!("{place}.{k}"), file);
        let axes: Vec<Axis> = files.iter().enumerate().map(axis).collect::<Result<_>>()?;
        for (k, axis) in axes.iter().enumerate() {
            if axes[..k].iter().any(|other| other.key == axis.key) {
                let expected = "expected each key once";
                return Err(checked.fault(&format!("{place}.{k}.key"), expected).into());
            }
        }
        Ok(axes)
    }

    /// Returns its values that are words.
    pub fn texts(&self) -> Vec<String> {
        let Values::List(list) = &self.values else { return Vec::new() };
        let text = |value: &String| {
            let value = value.parse::<toml_edit::Value>().ok()?;
            value.as_str().map(str::to_owned)
        };
        list.iter().filter_map(text).collect()
    }

    fn new(checked: &Checked, place: &str, file: &AxisFile) -> Result<Axis> {
        let fault = |field: &str, expected: &str| -> Input {
            checked.fault(&format!("{place}.{field}"), expected)
        };
        if file.key == "seed" {
            let expected = "every point has random numbers of its own; see repeats";
            return Err(fault("key", expected).into());
        }
        let values = match (&file.values, &file.range, &file.distribution) {
            (Some(values), None, None) => Values::List(values.iter().map(Value::text).collect()),
            (None, Some(range), None) => {
                let option = format!("{}={range}", file.key);
                let axis = dataset::Axis::parse("range", &option);
                let axis =
                    axis.map_err(|error| at_key(checked, &format!("{place}.range"), error))?;
                Values::List(axis.values.iter().map(f64::to_string).collect())
            }
            (None, None, Some(kind)) => {
                let quantiles = quantiles(file, *kind, &fault)?;
                Values::Drawn { quantiles, count: file.count }
            }
            (None, None, None) => {
                let scale = file.scale.unwrap_or_default();
                Values::Range { ends: ends(file, scale, &fault)?, scale, count: file.count }
            }
            _ => {
                let expected = "expected one of values, range, from and to, or distribution";
                return Err(fault("key", expected).into());
            }
        };
        let is_text = file.values.iter().flatten().any(Value::is_text);
        let mut axis = Axis { key: file.key.clone(), is_text, values, is_whole: false };
        if axis.count().is_some_and(|count| !(1..=MOST_VALUES).contains(&count)) {
            let expected = format!("expected 1 to {MOST_VALUES} values");
            let field = if file.values.is_some() { "values" } else { "count" };
            return Err(fault(field, &expected).into());
        }
        axis.is_whole = !axis.is_text && is_whole(&axis.key);
        axis.check(checked, place)?;
        Ok(axis)
    }

    /// Checks that the scenario accepts the values: all of a list, or the ends of a range.
    fn check(&self, checked: &Checked, place: &str) -> Result<()> {
        let (field, shown) = match &self.values {
            Values::List(list) => ("key", list.clone()),
            Values::Range { .. } => ("key", vec![self.at(0.0), self.at(1.0)]),
            Values::Drawn { .. } => ("key", vec![self.at(0.5)]),
        };
        for value in shown {
            let assignment = format!("{}={value}", self.key);
            let fault = |error| at_key(checked, &format!("{place}.{field}"), error);
            assign::<Scenario>(&mut Table::new(), "axis", &assignment).map_err(fault)?;
        }
        Ok(())
    }

    /// Returns the number of values, if the axis defines it.
    pub fn count(&self) -> Option<u64> {
        match &self.values {
            Values::List(list) => Some(list.len() as u64),
            Values::Range { count, .. } | Values::Drawn { count, .. } => *count,
        }
    }

    /// Returns whether its values are random.
    pub fn is_drawn(&self) -> bool {
        matches!(self.values, Values::Drawn { .. })
    }

    /// Returns the value with index `place`, as TOML; of a random axis, the quantile `u`.
    pub fn value(&self, place: u64, u: f64) -> String {
        match &self.values {
            Values::List(list) => list[place as usize].clone(),
            Values::Range { count, .. } => {
                self.at(place as f64 / (count.unwrap_or(1).max(2) - 1) as f64)
            }
            Values::Drawn { .. } => self.at(u),
        }
    }

    /// Returns the quantile `u`.
    pub fn at(&self, u: f64) -> String {
        match &self.values {
            Values::List(list) => {
                list[((u * list.len() as f64) as usize).min(list.len() - 1)].clone()
            }
            Values::Range { ends, scale, .. } => self.shown(between(*ends, *scale, u)),
            Values::Drawn { quantiles, .. } => self.shown(quantiles.at(u)),
        }
    }

    fn shown(&self, value: f64) -> String {
        number(if self.is_whole { value.round() } else { value })
    }
}

impl Value {
    fn text(&self) -> String {
        match self {
            Value::Integer(number) => number.to_string(),
            Value::Float(number) => number.to_string(),
            Value::Flag(flag) => flag.to_string(),
            Value::Text(text) => toml_edit::Value::from(text.as_str()).to_string(),
        }
    }

    fn is_text(&self) -> bool {
        matches!(self, Value::Flag(_) | Value::Text(_))
    }
}

/// Formats a number with at most twelve digits.
pub fn number(value: f64) -> String {
    rounded(value).to_string()
}

/// Rounds a number to twelve digits.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// Returns whether a key accepts whole numbers only.
pub fn is_whole(key: &str) -> bool {
    let takes = |value: &str| {
        assign::<Scenario>(&mut Table::new(), "axis", &format!("{key}={value}"))
            .map_err(|error| error.to_string())
    };
    takes("1.5").is_err_and(|error| error.contains("expected a whole number"))
}

/// Creates an error at a field of an axis, from the field and the expectation.
pub type Fault<'a> = &'a dyn Fn(&str, &str) -> Input;

/// Returns the ends of an axis's range, in ascending order.
fn ends(file: &AxisFile, scale: Scale, fault: Fault) -> Result<[f64; 2]> {
    let (Some(from), Some(to)) = (file.from, file.to) else {
        let expected = "expected values, range, from and to, or distribution";
        return Err(fault("key", expected).into());
    };
    checked_ends([from, to], scale, fault)
}

/// Checks that the ends of a range are in ascending order, and above 0 on a logarithmic scale.
pub fn checked_ends([from, to]: [f64; 2], scale: Scale, fault: Fault) -> Result<[f64; 2]> {
    if !(from.is_finite() && to.is_finite() && from < to) {
        return Err(fault("to", "expected a number above from: the range is empty").into());
    }
    if scale == Scale::Log && from <= 0.0 {
        return Err(fault("from", "expected a number above 0 for a logarithmic range").into());
    }
    Ok([from, to])
}

fn quantiles(file: &AxisFile, kind: Distribution, fault: Fault) -> Result<Quantiles> {
    let normal = |is_log| -> Result<Quantiles> {
        let (Some(mean), Some(sd)) = (file.mean, file.sd.filter(|sd| *sd > 0.0)) else {
            return Err(fault("distribution", "expected mean, and sd above 0").into());
        };
        let part = |end: f64| {
            let end = if is_log { libm::log(end) } else { end };
            normal_cdf((end - mean) / sd)
        };
        let parts = [file.from.map_or(0.0, part), file.to.map_or(1.0, part)];
        if parts[0] < parts[1] {
            Ok(Quantiles::Normal { mean, sd, parts, is_log })
        } else {
            Err(fault("to", "nothing of the distribution lies between from and to").into())
        }
    };
    let uniform = |scale| -> Result<_> { Ok(Quantiles::Uniform(ends(file, scale, fault)?, scale)) };
    Ok(match kind {
        Distribution::Uniform => uniform(Scale::Linear)?,
        Distribution::LogUniform => uniform(Scale::Log)?,
        Distribution::Normal => normal(false)?,
        Distribution::LogNormal => normal(true)?,
        Distribution::Triangular => {
            let [from, to] = ends(file, Scale::Linear, fault)?;
            match file.mode {
                Some(mode) if (from..=to).contains(&mode) => {
                    Quantiles::Triangular([from, mode, to])
                }
                _ => return Err(fault("mode", "expected a number within from and to").into()),
            }
        }
    })
}
