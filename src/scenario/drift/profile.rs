//! Profiles of temperature and supply over time.

use std::ops::RangeInclusive;

use serde::Serialize;

use crate::error::{Input, Result};
use crate::files::csv::CsvInput;

/// Temperature range of a commercial part (DS182), the same as for the keys [degC].
pub const DIE_C: RangeInclusive<f64> = 0.0..=85.0;
/// Tolerance of the supply voltage (DS182), the same as for the keys [mV].
pub const SUPPLY_MV: RangeInclusive<f64> = -30.0..=30.0;
/// Columns of a profile's file.
const HEADER: [&str; 3] = ["time_s", "temperature_c", "supply_mv"];
/// Largest number of rows of a profile.
const MOST: usize = 100_000;

/// Conditions of the die at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Moment {
    /// Time [s].
    pub time_s: f64,
    /// Temperature of the die [degC].
    pub temperature_c: f64,
    /// Deviation of the fabric's supply from its nominal voltage [mV].
    pub supply_mv: f64,
}

/// Conditions in order of time, at least one.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile(Vec<Moment>);

impl Profile {
    /// Creates a linear temperature ramp of `moments` points, at least two.
    pub fn ramp(from_c: f64, to_c: f64, duration_s: f64, moments: usize, supply_mv: f64) -> Self {
        let steps = moments.max(2) - 1;
        let at = |k: usize| {
            let part = k as f64 / steps as f64;
            let temperature_c = from_c + part * (to_c - from_c);
            Moment { time_s: part * duration_s, temperature_c, supply_mv }
        };
        Profile((0..=steps).map(at).collect())
    }

    /// Parses CSV with the columns `time_s`, `temperature_c` and `supply_mv`.
    ///
    /// # Errors
    /// The line and column of a value that is not a number, of a time that is not later than its predecessor, or of
    /// conditions outside the part's specification.
    pub fn parse(source: &str, text: &str) -> Result<Self> {
        let mut moments: Vec<Moment> = Vec::new();
        let mut input = CsvInput::new(source, text, &HEADER)?;
        while input.advance()? {
            let field = |index: usize, range: RangeInclusive<f64>, expected: &str| {
                let value = input.field::<f64>(index).filter(|value| range.contains(value));
                value.ok_or_else(|| input.fault(index, format!("expected {expected}")))
            };
            let moment = Moment {
                time_s: field(0, 0.0..=1e9, "a time from 0 to 1e9 s")?,
                temperature_c: field(
                    1,
                    DIE_C,
                    "a temperature from 0 to 85 degC, the part's range",
                )?,
                supply_mv: field(2, SUPPLY_MV, "a deviation from -30 to 30 mV")?,
            };
            if moments.last().is_some_and(|last| last.time_s >= moment.time_s) {
                return Err(input.fault(0, "expected a time after the one before").into());
            }
            if moments.len() == MOST {
                return Err(input.fault(0, format!("expected {MOST} rows at most")).into());
            }
            moments.push(moment);
        }
        if moments.is_empty() {
            return Err(Input::new(source, "expected one row at least").into());
        }
        Ok(Profile(moments))
    }

    /// Returns the conditions at all listed times.
    pub fn moments(&self) -> &[Moment] {
        &self.0
    }

    /// Interpolates the conditions at `time_s`, linearly between two rows.
    pub fn at(&self, time_s: f64) -> Moment {
        let after = self.0.partition_point(|moment| moment.time_s <= time_s);
        let before = self.0[after.max(1) - 1];
        let Some(next) = self.0.get(after).filter(|_| after > 0) else { return before };
        let part = (time_s - before.time_s) / (next.time_s - before.time_s);
        let between = |from: f64, to: f64| from + part * (to - from);
        Moment {
            time_s,
            temperature_c: between(before.temperature_c, next.temperature_c),
            supply_mv: between(before.supply_mv, next.supply_mv),
        }
    }

    /// Returns the lowest and highest temperature [degC].
    pub fn temperatures_c(&self) -> [f64; 2] {
        let all = self.0.iter().map(|moment| moment.temperature_c);
        [all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_is_even_and_is_known_between_its_moments() {
        let ramp = Profile::ramp(25.0, 65.0, 600.0, 5, 1.0);
        let temperatures: Vec<_> = ramp.moments().iter().map(|at| at.temperature_c).collect();
        assert_eq!(temperatures, [25.0, 35.0, 45.0, 55.0, 65.0]);
        let between = Moment { time_s: 75.0, temperature_c: 30.0, supply_mv: 1.0 };
        assert_eq!(ramp.at(75.0), between);
        assert_eq!(ramp.at(600.0).temperature_c, 65.0);
        assert_eq!(ramp.at(1e6).temperature_c, 65.0);
        assert_eq!(ramp.temperatures_c(), [25.0, 65.0]);
    }

    #[test]
    fn faults_of_a_file_are_named_by_line_and_column() {
        let error = |rows: &str| {
            let text = format!("time_s,temperature_c,supply_mv\n{rows}");
            Profile::parse("p.csv", &text).unwrap_err().to_string()
        };
        assert!(error("").contains("p.csv: expected one row"), "{}", error(""));
        assert!(
            error("0,25,0\n5,86,0\n").contains("p.csv:3:3: temperature_c = 86: expected a temp")
        );
        assert!(error("0,nan,0\n").contains("p.csv:2:3: temperature_c = nan"));
        assert!(error("0,25,0\n0,30,0\n").contains("p.csv:3:1: time_s = 0: expected a time after"));
        assert!(error("0,25,99\n").contains("supply_mv = 99"));
        let two = Profile::parse("p", "time_s,temperature_c,supply_mv\n0,25,0\n9,30,-5\n").unwrap();
        assert_eq!(two.at(4.5).supply_mv, -2.5);
    }
}
