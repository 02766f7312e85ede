//! Sums of an epoch over all samples, and the resulting normal equations.

use super::basis::LANES;
use super::cholesky::Symmetric;
use super::gram::{Gram, Moments};
use super::lm::NormalEquations;

/// Number of parameters of a network with so many columns: for each neuron its knots and its bias, then the
/// output layer's weights and its bias.
pub fn parameters(neurons: usize, columns: usize) -> usize {
    neurons * (columns + 1) + 1
}

/// Sums over samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    /// Squares of the residuals.
    pub cost: f64,
    /// Products of derivatives with respect to two neurons, weights `k (k + 1) / 2 + l`.
    pub gram: Gram,
    /// The same of a neuron and an output, weights `k (neurons + 1) + l`.
    pub cross: Moments,
    /// Products of derivatives with respect to the output layer, full square.
    pub corner: Vec<f64>,
    /// J'r.
    pub gradient: Vec<f64>,
}

impl Sums {
    /// Zeros for so many columns.
    pub fn zeros(neurons: usize, columns: usize) -> Self {
        let tiles = columns / LANES;
        Sums {
            cost: 0.0,
            gram: Gram::zeros(neurons * (neurons + 1) / 2, tiles),
            cross: Moments::zeros(neurons * (neurons + 1), tiles),
            corner: vec![0.0; (neurons + 1) * (neurons + 1)],
            gradient: vec![0.0; parameters(neurons, columns)],
        }
    }

    /// The sum of both.
    pub fn with(mut self, other: &Sums) -> Self {
        self.cost += other.cost;
        self.gram.add(&other.gram);
        self.cross.add(&other.cross);
        self.corner.iter_mut().zip(&other.corner).for_each(|(sum, other)| *sum += other);
        self.gradient.iter_mut().zip(&other.gradient).for_each(|(sum, other)| *sum += other);
        self
    }

    /// J'J / n and J'r / n from the sums of so many samples.
    pub fn assemble(&self, neurons: usize, samples: usize) -> NormalEquations {
        let (n, size) = (neurons, self.gradient.len());
        let columns = (size - 1) / n - 1;
        let output = n * columns;
        let mut matrix = Symmetric::zeros(size);
        let mut pair = 0;
        for k in 0..n {
            for l in 0..=k {
                for i in 0..columns {
                    // Of a neuron with itself the lower half is all there is.
                    for j in 0..if l == k { i + 1 } else { columns } {
                        matrix.add(k * columns + i, l * columns + j, self.gram.at(pair, i, j));
                    }
                }
                pair += 1;
            }
            for l in 0..=n {
                for i in 0..columns {
                    matrix.add(output + l, k * columns + i, self.cross.at(k * (n + 1) + l, i));
                }
            }
        }
        for k in 0..=n {
            (0..=k).for_each(|l| matrix.add(output + k, output + l, self.corner[k * (n + 1) + l]));
        }
        let share = 1.0 / samples as f64;
        matrix.scale(share);
        let gradient = self.gradient.iter().map(|sum| sum * share).collect();
        NormalEquations { cost: self.cost * share, matrix, gradient }
    }
}
