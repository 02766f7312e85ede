//! A column of a sweep over another, and what can be said of it.

use super::values::{Value, Values};

/// Standard errors by which a trend may be missed from one point to the next [1].
const SLACK: f64 = 3.0;
/// The same of a point that was evaluated once, and has no standard error, as a part of its value [1].
const ROUGHLY: f64 = 0.05;

/// Points along an axis: place, value, and standard error of the value.
pub struct Line(Vec<(f64, f64, Option<f64>)>);

impl Line {
    /// Sorts points by their place.
    pub fn new(points: impl IntoIterator<Item = (f64, f64, Option<f64>)>) -> Self {
        let mut points: Vec<_> = points.into_iter().collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Line(points)
    }

    /// Returns place and value of each point as `x` and `y`.
    pub fn points(&self) -> impl Iterator<Item = Values> {
        self.0.iter().map(|&(x, y, error)| {
            let mut point = Values::default();
            point.put("x", x);
            point.put_value("y", Value::Number(y, error));
            point
        })
    }

    /// Returns what a claim can compare: the values `y`, their `count`, the `first`, `previous` and `last` of them, `least`,
    /// `largest` and `furthest` from 0, `largest_step`, the standard error `last_se`, and whether it `rises` or `falls`.
    pub fn values(&self) -> Values {
        let of = |point: Option<&(f64, f64, Option<f64>)>| {
            point.map_or(Value::Number(f64::NAN, None), |&(_, y, error)| Value::Number(y, error))
        };
        let y = || self.0.iter().map(|point| point.1);
        let largest =
            |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(f64::NEG_INFINITY, f64::max);
        let mut steps = self.0.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs());
        let mut values = Values::default();
        values.put_value("y", Value::List(y().collect()));
        values.put("count", self.0.len() as f64);
        values.put_value("first", of(self.0.first()));
        values.put_value("previous", of(self.0.iter().nth_back(1)));
        values.put_value("last", of(self.0.last()));
        values.put("least", y().fold(f64::INFINITY, f64::min));
        values.put("largest", largest(&mut y()));
        values.put("furthest", largest(&mut y().map(f64::abs)));
        values.put("largest_step", largest(&mut steps));
        values.put("last_se", self.0.last().and_then(|point| point.2).unwrap_or_default());
        values.put("rises", f64::from(self.goes(1.0)));
        values.put("falls", f64::from(self.goes(-1.0)));
        values
    }

    /// Returns the part of the points at which the magnitude exceeds that of another line [1].
    pub fn leads(&self, other: &Line) -> f64 {
        let pairs = self.0.iter().zip(&other.0);
        let larger = pairs.filter(|(one, other)| one.1.abs() > other.1.abs()).count();
        larger as f64 / self.0.len() as f64
    }

    /// Returns whether values rise (`sign` 1) or fall (-1) from point to point, as far as their standard errors tell, and
    /// do so in all.
    fn goes(&self, sign: f64) -> bool {
        let steps = self.0.windows(2).all(|pair| {
            let ((_, before, one), (_, after, other)) = (pair[0], pair[1]);
            let slack = match one.zip(other) {
                Some((one, other)) => SLACK * one.hypot(other),
                None => ROUGHLY * before.abs(),
            };
            sign * (after - before) >= -slack
        });
        let ends = self.0.first().zip(self.0.last());
        steps
            && self.0.len() > 1
            && ends.is_some_and(|(first, last)| sign * (last.1 - first.1) > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(values: [f64; 3], error: Option<f64>) -> Line {
        Line::new(values.into_iter().enumerate().map(|(k, value)| (k as f64, value, error)))
    }

    #[test]
    fn a_trend_may_be_missed_by_noise_and_not_by_more() {
        assert!(line([1.0, 2.0, 3.0], Some(0.0)).goes(1.0));
        assert!(!line([1.0, 2.0, 3.0], Some(0.0)).goes(-1.0));
        assert!(line([1.0, 0.97, 3.0], Some(0.01)).goes(1.0));
        assert!(!line([1.0, 0.9, 3.0], Some(0.01)).goes(1.0));
        assert!(line([1.0, 0.97, 3.0], None).goes(1.0));
        assert!(!line([3.0, 3.0, 3.0], Some(0.1)).goes(1.0), "nothing moves");
    }

    #[test]
    fn claims_compare_what_a_line_has() {
        let values = line([1.0, -4.0, 2.0], Some(0.1)).values();
        for condition in [
            "count >= 3",
            "first <= 1",
            "previous < -3",
            "last > 1",
            "least < -3",
            "largest <= 2",
            "furthest >= 4",
            "largest_step >= 6",
            "last_se > 0",
        ] {
            assert!(values.holds(condition).unwrap(), "{condition}");
        }
        assert!(!values.holds("rises").unwrap() && !values.holds("falls").unwrap());
        let trends = |values| {
            ["rises", "falls"].map(|trend| line(values, None).values().holds(trend).unwrap())
        };
        assert_eq!(trends([3.0, 2.0, 1.0]), [false, true]);
        assert_eq!(trends([1.0, 2.0, 3.0]), [true, false]);
    }

    #[test]
    fn one_line_leads_another_by_magnitude() {
        let (one, other) = (line([-2.0, 0.0, 3.0], None), line([1.0, -1.0, 1.0], None));
        assert!((one.leads(&other) - 2.0 / 3.0).abs() < 1e-12);
    }
}
