//! Penalties that keep the weights within their words, by default those of Table 6.4: one-sided squared hinges.

use serde::{Deserialize, Serialize};

use tofsim::firmware::depth_estimator::datapath::Datapath;

use super::features::Scaling;
use super::lm::NormalEquations;

/// Starts of the penalties, slightly inside the words' ranges, and their slopes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WordLimits {
    /// Factor on all squares; the data's mean square is near 1.
    pub penalty: f64,
    /// Magnitude of W1, of its word's range [1].
    pub w1_share: f64,
    /// Magnitude of B1, of its word's range [1].
    pub b1_share: f64,
    /// Magnitude of W2, of its word's range [1].
    pub w2_share: f64,
    /// Steepness for W2 [1/m].
    pub w2_slope: f64,
    /// Magnitude of B2, of its word's range [1].
    pub b2_share: f64,
    /// Steepness for B2 [1/m].
    pub b2_slope: f64,
}

impl Default for WordLimits {
    fn default() -> Self {
        WordLimits {
            penalty: 0.5,
            w1_share: 0.96,
            b1_share: 0.975,
            w2_share: 0.975,
            w2_slope: 4.0,
            b2_share: 0.98,
            b2_slope: 100.0,
        }
    }
}

/// The penalties of a network for certain words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hinges {
    /// Starts of the penalties.
    pub limits: WordLimits,
    /// The words.
    pub words: Datapath,
}

/// A parameter and the derivative of a hinge with respect to it.
type Slope = (usize, f64);

impl Hinges {
    /// Sum of the penalties of a network.
    pub fn cost(&self, x: &[f64], neurons: usize, scaling: &Scaling) -> f64 {
        let mut sum = 0.0;
        self.visit(x, neurons, scaling, |hinge, _| sum += hinge * hinge);
        self.limits.penalty * sum
    }

    /// Adds the penalties to normal equations.
    pub fn add(&self, x: &[f64], neurons: usize, scaling: &Scaling, linear: &mut NormalEquations) {
        self.visit(x, neurons, scaling, |hinge, slopes| {
            linear.cost += self.limits.penalty * hinge * hinge;
            for (place, &(row, slope)) in slopes.iter().enumerate() {
                linear.gradient[row] += self.limits.penalty * hinge * slope;
                for &(column, other) in &slopes[..=place] {
                    linear.matrix.add(row, column, self.limits.penalty * slope * other);
                }
            }
        });
    }

    /// Shows all hinges above zero.
    fn visit(
        &self,
        x: &[f64],
        neurons: usize,
        scaling: &Scaling,
        mut hinge: impl FnMut(f64, &[Slope]),
    ) {
        let (limits, words) = (&self.limits, &self.words);
        let w1 = limits.w1_share * words.w1.range();
        let b1 = limits.b1_share * words.b1.range();
        let w2_m = limits.w2_share * words.w2.range();
        let b2_m = limits.b2_share * words.b2.range();
        let mut outside = |value: f64, limit: f64, slope: f64, slopes: &mut [Slope]| {
            let excess = slope * (value.abs() - limit);
            if excess > 0.0 {
                let sign = slope * value.signum();
                slopes.iter_mut().for_each(|(_, slope)| *slope *= sign);
                hinge(excess, slopes);
            }
        };
        let columns = scaling.columns();
        for (k, row) in x.chunks_exact(columns).take(neurons).enumerate() {
            let first = k * columns;
            // B1 is what the centring leaves of the bias.
            let mut slopes = vec![(first + columns - 1, 1.0)];
            let mut bias = row[columns - 1];
            let of_raw = scaling.inverse_scale.iter().zip(&scaling.centre);
            for ((place, weight), (of_raw, centre)) in (first..).zip(row).zip(of_raw) {
                let relative = of_raw / w1;
                outside(weight * relative, 1.0, 1.0, &mut [(place, relative)]);
                bias -= weight * of_raw * centre;
                slopes.push((place, -of_raw * centre));
            }
            outside(bias, b1, 1.0, &mut slopes);
        }
        let output = neurons * columns;
        for (place, weight) in (output..).zip(&x[output..output + neurons]) {
            outside(*weight, w2_m, limits.w2_slope, &mut [(place, 1.0)]);
        }
        let place = output + neurons;
        outside(x[place], b2_m, limits.b2_slope, &mut [(place, 1.0)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::cholesky::Symmetric;
    use tofsim::kernel::WordFormat;

    #[test]
    fn the_penalties_derivatives_are_their_differences() {
        let centre = (0..71).map(|k| k as f64).collect();
        let scaling = Scaling { centre, inverse_scale: vec![0.004; 71], ..Scaling::default() };
        // Two neurons; every kind of hinge is above zero.
        let mut x: Vec<f64> = (0..2 * 72).map(|k| (k as f64 * 0.37).sin() * 1.5).collect();
        x[71] = 9.0;
        x[72 + 71] = -9.0;
        x.extend([2.1, -2.2, -0.3]);
        let (limits, size) =
            (Hinges { limits: WordLimits::default(), words: Datapath::THESIS }, x.len());
        let zeros = Symmetric::zeros(size);
        let mut linear = NormalEquations { cost: 0.0, matrix: zeros, gradient: vec![0.0; size] };
        limits.add(&x, 2, &scaling, &mut linear);
        assert!((linear.cost - limits.cost(&x, 2, &scaling)).abs() < 1e-12 * linear.cost);
        for place in 0..size {
            let mut moved = [x.clone(), x.clone()];
            moved[0][place] += 1e-6;
            moved[1][place] -= 1e-6;
            let [above, below] = moved.map(|x| limits.cost(&x, 2, &scaling));
            let (found, expected) = (2.0 * linear.gradient[place], (above - below) / 2e-6);
            assert!((found - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{place}");
        }
        // One square of slope 100 alone: its curvature is penalty 100^2.
        assert!((linear.matrix.at(size - 1, size - 1) - 5000.0).abs() < 1e-9);
    }

    #[test]
    fn a_network_well_inside_costs_nothing() {
        let scaling =
            Scaling { centre: vec![10.0; 71], inverse_scale: vec![0.1; 71], ..Scaling::default() };
        let x = vec![0.001; 8 * 72 + 9];
        let hinges = |words: Datapath| Hinges { limits: WordLimits::default(), words };
        assert_eq!(hinges(Datapath::THESIS).cost(&x, 8, &scaling), 0.0);
        // A word that ends at 6e-5, and a weight of 1e-4 for raw counts.
        let short = Datapath { w1: WordFormat { width: 2, fraction: 15 }, ..Datapath::THESIS };
        assert!(hinges(short).cost(&x, 8, &scaling) > 0.0);
    }
}
