//! The cubic spline with not-a-knot ends, as MATLAB's `spline` and `interp1(..., 'spline')`.
//!
//! Piecewise cubic with two continuous derivatives; the third is continuous too at the second knot
//! and at the last but one (de Boor, A Practical Guide to Splines, ch. IV). Two knots make a straight
//! line, three a parabola.

/// A spline through given points.
#[derive(Clone, Debug)]
pub struct Spline {
    knots: Vec<f64>,
    values: Vec<f64>,
    /// First derivative at the knots.
    slopes: Vec<f64>,
}

impl Spline {
    /// Through the points (`knots[k]`, `values[k]`); `None` for less than two points, unequal numbers of
    /// knots and values, numbers that are not finite, or knots that do not rise.
    pub fn new(knots: &[f64], values: &[f64]) -> Option<Self> {
        let is_finite = knots.iter().chain(values).all(|value| value.is_finite());
        let is_rising = knots.is_sorted_by(|a, b| a < b);
        if knots.len() < 2 || knots.len() != values.len() || !is_finite || !is_rising {
            return None;
        }
        let slopes = slopes(knots, values);
        Some(Spline { knots: knots.to_vec(), values: values.to_vec(), slopes })
    }

    /// Value at `x`; outside the knots the first or last cubic goes on.
    pub fn at(&self, x: f64) -> f64 {
        let next = self.knots.partition_point(|&knot| knot <= x).clamp(1, self.knots.len() - 1);
        let k = next - 1;
        let (width, from) = (self.knots[next] - self.knots[k], x - self.knots[k]);
        let chord = (self.values[next] - self.values[k]) / width;
        let bend = (self.slopes[k] + self.slopes[next] - 2.0 * chord) / width;
        let square = (chord - self.slopes[k]) / width - bend;
        self.values[k] + from * (self.slopes[k] + from * (square + from * bend / width))
    }
}

/// First derivatives at the knots, from one equation for each: a tridiagonal system, whose pivots are
/// positive for any widths.
fn slopes(knots: &[f64], values: &[f64]) -> Vec<f64> {
    let width: Vec<_> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let rise = values.windows(2).map(|pair| pair[1] - pair[0]);
    let chord: Vec<_> = rise.zip(&width).map(|(rise, width)| rise / width).collect();
    match *chord {
        [chord] => return vec![chord; 2],
        [first, second] => {
            let curvature = (second - first) / (width[0] + width[1]);
            let (before, after) = (width[0] * curvature, width[1] * curvature);
            return vec![first - before, first + before, second + after];
        }
        _ => {}
    }
    let last = width.len() - 1;
    // Above the diagonal, after division by the pivot; and the right side, likewise.
    let mut above = Vec::with_capacity(knots.len());
    let mut right = Vec::with_capacity(knots.len());
    let two = width[0] + width[1];
    let ends = (width[0] + 2.0 * two) * width[1] * chord[0] + width[0] * width[0] * chord[1];
    above.push(two / width[1]);
    right.push(ends / two / width[1]);
    for k in 1..=last {
        let pivot = 2.0 * (width[k - 1] + width[k]) - width[k] * above[k - 1];
        let sum = 3.0 * (width[k] * chord[k - 1] + width[k - 1] * chord[k]);
        above.push(width[k - 1] / pivot);
        right.push((sum - width[k] * right[k - 1]) / pivot);
    }
    let two = width[last - 1] + width[last];
    let ends = width[last] * width[last] * chord[last - 1]
        + (2.0 * two + width[last]) * width[last - 1] * chord[last];
    let pivot = width[last - 1] - two * above[last];
    right.push((ends / two - two * right[last]) / pivot);
    for k in (0..=last).rev() {
        right[k] -= above[k] * right[k + 1];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{a} for {b}");
    }

    #[test]
    fn a_cubic_is_its_own_spline_on_any_knots() {
        let cubic = |x: f64| 2.0 - x + 0.5 * x * x - 0.25 * x * x * x;
        let knots = [-2.0, -1.9, 0.0, 0.3, 2.0, 7.0];
        for count in 4..=knots.len() {
            let values: Vec<_> = knots[..count].iter().map(|&x| cubic(x)).collect();
            let spline = Spline::new(&knots[..count], &values).unwrap();
            for x in [-3.0, -2.0, -1.95, -1.0, 0.0, 0.1, 1.0, 5.0, 7.0, 8.0] {
                close(spline.at(x), cubic(x));
            }
        }
    }

    #[test]
    fn two_points_make_a_line_and_three_a_parabola() {
        let line = Spline::new(&[1.0, 3.0], &[2.0, 8.0]).unwrap();
        close(line.at(2.5), 6.5);
        let parabola = Spline::new(&[-1.0, 0.5, 3.0], &[1.0, 0.25, 9.0]).unwrap();
        [-2.0, -0.25, 0.5, 2.0, 4.0].into_iter().for_each(|x: f64| close(parabola.at(x), x * x));
    }

    #[test]
    fn it_goes_through_its_points() {
        let knots = [0.0, 1.0, 1.5, 4.0, 4.5, 9.0];
        let values = [3.0, -1.0, 4.0, 1.0, -5.0, 9.0];
        let spline = Spline::new(&knots, &values).unwrap();
        knots.iter().zip(values).for_each(|(&knot, value)| close(spline.at(knot), value));
    }

    #[test]
    fn what_has_no_spline_is_refused() {
        assert!(Spline::new(&[1.0], &[1.0]).is_none());
        assert!(Spline::new(&[1.0, 2.0], &[1.0]).is_none());
        assert!(Spline::new(&[1.0, f64::NAN], &[1.0, 2.0]).is_none());
        assert!(Spline::new(&[1.0, 1.0], &[1.0, 2.0]).is_none());
    }
}
