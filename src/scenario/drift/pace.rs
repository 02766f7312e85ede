//! Scale factor of a chain's delays over time.

use crate::kernel::Time;

/// Scale factor of a chain's [`Delays`] as a piecewise linear function of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pace(Vec<(Time, f64)>);

impl Pace {
    /// Creates the function from points in order of time, each with a scale factor. It is linear between points, and
    /// constant before the first and after the last.
    pub fn new(points: Vec<(Time, f64)>) -> Self {
        Pace(points)
    }

    /// Returns the scale factor at `now` [1].
    pub fn at(&self, now: Time) -> f64 {
        let after = self.0.partition_point(|(at, _)| *at <= now);
        let Some(&(then, from)) = after.checked_sub(1).and_then(|before| self.0.get(before)) else {
            return self.0.first().map_or(1.0, |(_, factor)| *factor);
        };
        let Some(&(next, to)) = self.0.get(after) else { return from };
        from + (to - from) * ((now - then).fs() as f64 / (next - then).fs() as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pace_is_linear_between_its_points_and_still_beyond_them() {
        let pace = Pace::new(vec![(Time::from_ns(10), 1.0), (Time::from_ns(30), 1.04)]);
        for (ns, factor) in [(0, 1.0), (10, 1.0), (15, 1.01), (30, 1.04), (99, 1.04)] {
            assert!((pace.at(Time::from_ns(ns)) - factor).abs() < 1e-12, "{ns}");
        }
        assert_eq!(Pace::default().at(Time::ZERO), 1.0);
    }
}
