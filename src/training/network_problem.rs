//! The network's error as a sum of squares, with its derivatives.
//!
//! A sample has the residual u (depth - distance), where u is its weight, and, for the noise that the
//! activation table's steps are, a residual q u w2 (1 - a^2) for each neuron: an error of q in the
//! sum of a neuron would move the depth by so much. The latter belong to one neuron alone, so they
//! only change the weights of the sums in [`super::gram`].

use rayon::prelude::*;

use super::cholesky::Symmetric;
use super::features::{BLOCK, Block, COLUMNS, Features, LANES, Scaling, TILES, tile};
use super::gram::{GROUP, Gram, Moments, Weights, groups};
use super::limits::Limits;
use super::lm::{Linear, Problem};

/// Blocks that a thread sums up at a time. Fixed, as the order of sums is.
const RUN: usize = 8;

/// Number of parameters of a network: for each neuron its knots and its bias, then the output
/// layer's weights and its bias.
pub fn parameters(neurons: usize) -> usize {
    neurons * (COLUMNS + 1) + 1
}

/// Samples, their weights, and what else is to be small.
#[derive(Debug)]
pub struct NetworkProblem<'a> {
    /// Inputs.
    pub features: &'a Features,
    /// How the inputs were made.
    pub scaling: &'a Scaling,
    /// True distances [m].
    pub distances_m: &'a [f64],
    /// Weight u of each sample [1/m].
    pub weights: &'a [f64],
    /// Hidden neurons.
    pub neurons: usize,
    /// Noise q of a neuron's sum from the table's steps [1].
    pub table_noise: f64,
    /// Penalties.
    pub limits: Limits,
}

/// Sums over samples.
struct Sums {
    cost: f64,
    gram: Gram,
    cross: Moments,
    /// Products of derivatives with respect to the output layer, full square.
    corner: Vec<f64>,
    gradient: Vec<f64>,
}

impl Sums {
    fn zeros(neurons: usize) -> Self {
        Sums {
            cost: 0.0,
            gram: Gram::zeros(neurons * (neurons + 1) / 2),
            cross: Moments::zeros(neurons * (neurons + 1)),
            corner: vec![0.0; (neurons + 1) * (neurons + 1)],
            gradient: vec![0.0; parameters(neurons)],
        }
    }

    fn add(mut self, other: &Sums) -> Self {
        self.cost += other.cost;
        self.gram.add(&other.gram);
        self.cross.add(&other.cross);
        self.corner.iter_mut().zip(&other.corner).for_each(|(sum, other)| *sum += other);
        self.gradient.iter_mut().zip(&other.gradient).for_each(|(sum, other)| *sum += other);
        self
    }
}

/// What the samples of a block weigh in the sums.
struct Scratch {
    pairs: Weights,
    cross: Weights,
    activations: Vec<f64>,
    slopes: Vec<f64>,
    outputs: Vec<f64>,
}

impl Scratch {
    fn new(neurons: usize) -> Self {
        let weights = |count| vec![[[0.0; GROUP]; BLOCK]; groups(count)];
        Scratch {
            pairs: weights(neurons * (neurons + 1) / 2),
            cross: weights(neurons * (neurons + 1)),
            activations: vec![0.0; neurons],
            slopes: vec![0.0; neurons],
            outputs: vec![0.0; neurons + 1],
        }
    }
}

impl NetworkProblem<'_> {
    /// Sums of a neuron's inputs, lane by lane and then over the lanes.
    #[inline(always)]
    fn sum(block: &Block, sample: usize, row: &[f64]) -> f64 {
        let mut sums = [0.0; LANES];
        for t in 0..TILES {
            let (inputs, weights) = (&tile(block, t)[sample], &row[t * LANES..][..LANES]);
            for lane in 0..LANES {
                sums[lane] += weights[lane] * f64::from(inputs[lane]);
            }
        }
        sums.iter().sum()
    }

    /// Depth of a sample; leaves the neurons' outputs in `activations` [m].
    #[inline(always)]
    fn depth(&self, x: &[f64], block: &Block, sample: usize, activations: &mut [f64]) -> f64 {
        let output = &x[self.neurons * COLUMNS..];
        let mut depth = output[self.neurons];
        for (k, activation) in activations.iter_mut().enumerate() {
            *activation = libm::tanh(Self::sum(block, sample, &x[k * COLUMNS..][..COLUMNS]));
            depth += output[k] * *activation;
        }
        depth
    }

    /// Squares of a block's residuals.
    #[inline(always)]
    fn block_cost(&self, x: &[f64], index: usize, activations: &mut [f64]) -> f64 {
        let (block, w2) = (&self.features.blocks()[index], &x[self.neurons * COLUMNS..]);
        let samples = index * BLOCK..self.features.samples().min((index + 1) * BLOCK);
        let mut cost = 0.0;
        for (place, sample) in samples.enumerate() {
            let error = self.depth(x, block, place, activations) - self.distances_m[sample];
            let u = self.weights[sample];
            cost += (u * error) * (u * error);
            for (k, a) in activations.iter().enumerate() {
                let noise = self.table_noise * u * w2[k] * (1.0 - a * a);
                cost += noise * noise;
            }
        }
        cost
    }

    /// Adds a block to the sums.
    #[inline(always)]
    fn add_block(&self, x: &[f64], index: usize, scratch: &mut Scratch, sums: &mut Sums) {
        let n = self.neurons;
        let (block, w2) = (&self.features.blocks()[index], &x[n * COLUMNS..]);
        let samples = index * BLOCK..self.features.samples().min((index + 1) * BLOCK);
        let used = samples.len();
        for weights in scratch.pairs.iter_mut().chain(&mut scratch.cross) {
            weights[used..].fill([0.0; GROUP]);
        }
        let q = self.table_noise;
        for (place, sample) in samples.enumerate() {
            let Scratch { pairs, cross, activations, slopes, outputs } = scratch;
            let u = self.weights[sample];
            let depth = self.depth(x, block, place, activations);
            let residual = u * (depth - self.distances_m[sample]);
            sums.cost += residual * residual;
            for (output, a) in outputs.iter_mut().zip(activations.iter().chain([&1.0])) {
                *output = u * a;
            }
            let (mut pair, mut mixed) = (0, 0);
            for k in 0..n {
                let a = activations[k];
                let flank = u * (1.0 - a * a);
                let slope = w2[k] * flank;
                slopes[k] = slope;
                // The table's residual and its derivatives, by the neuron's sum and by w2.
                let (noise, by_sum, by_w2) = (q * slope, -2.0 * a * q * slope, q * flank);
                sums.cost += noise * noise;
                for (l, &other) in slopes[..=k].iter().enumerate() {
                    let own = if l == k { by_sum * by_sum } else { 0.0 };
                    pairs[pair / GROUP][place][pair % GROUP] = (slope * other + own) as f32;
                    pair += 1;
                }
                for (l, output) in outputs.iter().enumerate() {
                    let own = if l == k { by_sum * by_w2 } else { 0.0 };
                    cross[mixed / GROUP][place][mixed % GROUP] = (slope * output + own) as f32;
                    mixed += 1;
                }
                let along = slope * residual + by_sum * noise;
                let gradient = &mut sums.gradient[k * COLUMNS..][..COLUMNS];
                for t in 0..TILES {
                    let inputs = &tile(block, t)[place];
                    for lane in 0..LANES {
                        gradient[t * LANES + lane] += along * f64::from(inputs[lane]);
                    }
                }
                sums.gradient[n * COLUMNS + k] += by_w2 * noise;
                sums.corner[k * (n + 1) + k] += by_w2 * by_w2;
            }
            for (k, output) in outputs.iter().enumerate() {
                sums.gradient[n * COLUMNS + k] += output * residual;
                for (l, other) in outputs.iter().enumerate() {
                    sums.corner[k * (n + 1) + l] += output * other;
                }
            }
        }
        sums.gram.add_block(block, &scratch.pairs);
        sums.cross.add_block(block, &scratch.cross);
    }

    /// Depth minus distance of each sample [m].
    pub fn errors(&self, x: &[f64]) -> Vec<f64> {
        let error = |sample: usize| {
            let (block, mut activations) = (sample / BLOCK, vec![0.0; self.neurons]);
            let block = &self.features.blocks()[block];
            self.depth(x, block, sample % BLOCK, &mut activations) - self.distances_m[sample]
        };
        (0..self.features.samples()).into_par_iter().map(error).collect()
    }

    /// Runs of neighbouring blocks, for the threads.
    fn runs(&self) -> Vec<std::ops::Range<usize>> {
        let blocks = self.features.blocks().len();
        (0..blocks).step_by(RUN).map(|first| first..blocks.min(first + RUN)).collect()
    }

    /// J'J / n and J'r / n from the sums.
    fn assemble(&self, sums: &Sums) -> Linear {
        let (n, output) = (self.neurons, self.neurons * COLUMNS);
        let mut matrix = Symmetric::zeros(parameters(n));
        let mut pair = 0;
        for k in 0..n {
            for l in 0..=k {
                for i in 0..COLUMNS {
                    // Of a neuron with itself the lower half is all there is.
                    for j in 0..if l == k { i + 1 } else { COLUMNS } {
                        matrix.add(k * COLUMNS + i, l * COLUMNS + j, sums.gram.at(pair, i, j));
                    }
                }
                pair += 1;
            }
            for l in 0..=n {
                for i in 0..COLUMNS {
                    matrix.add(output + l, k * COLUMNS + i, sums.cross.at(k * (n + 1) + l, i));
                }
            }
        }
        for k in 0..=n {
            (0..=k).for_each(|l| matrix.add(output + k, output + l, sums.corner[k * (n + 1) + l]));
        }
        let share = 1.0 / self.features.samples() as f64;
        matrix.scale(share);
        let gradient = sums.gradient.iter().map(|sum| sum * share).collect();
        Linear { cost: sums.cost * share, matrix, gradient }
    }
}

/// A run of blocks with the widest vectors that the processor has.
struct Costs<'a>(&'a NetworkProblem<'a>, &'a [f64], std::ops::Range<usize>);

impl pulp::WithSimd for Costs<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) -> f64 {
        let Costs(problem, x, run) = self;
        let mut activations = vec![0.0; problem.neurons];
        let mut cost = 0.0;
        for index in run {
            cost += problem.block_cost(x, index, &mut activations);
        }
        cost
    }
}

/// The same for the sums.
struct Linearise<'a>(&'a NetworkProblem<'a>, &'a [f64], std::ops::Range<usize>);

impl pulp::WithSimd for Linearise<'_> {
    type Output = Sums;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) -> Sums {
        let Linearise(problem, x, run) = self;
        let (mut scratch, mut sums) = (Scratch::new(problem.neurons), Sums::zeros(problem.neurons));
        for index in run {
            problem.add_block(x, index, &mut scratch, &mut sums);
        }
        sums
    }
}

impl Problem for NetworkProblem<'_> {
    fn parameters(&self) -> usize {
        parameters(self.neurons)
    }

    fn cost(&self, x: &[f64]) -> f64 {
        let arch = pulp::Arch::new();
        let costs = self.runs().into_par_iter().map(|run| arch.dispatch(Costs(self, x, run)));
        let sum: f64 = costs.collect::<Vec<_>>().iter().sum();
        let penalty = self.limits.cost(x, self.neurons, self.scaling);
        sum / self.features.samples() as f64 + penalty
    }

    fn linearise(&self, x: &[f64]) -> Linear {
        let arch = pulp::Arch::new();
        let parts = self.runs().into_par_iter().map(|run| arch.dispatch(Linearise(self, x, run)));
        let parts: Vec<Sums> = parts.collect();
        let sums = parts.iter().fold(Sums::zeros(self.neurons), Sums::add);
        let mut linear = self.assemble(&sums);
        self.limits.add(x, self.neurons, self.scaling, &mut linear);
        linear
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::Histogram;

    /// 300 histograms, so that the last block is not full, and a smooth network.
    fn counts() -> Vec<Histogram> {
        let one = |s: usize| -> Histogram {
            std::array::from_fn(|bin| ((s * 37 + bin * s * 3 + bin * bin) % 401) as u16)
        };
        (0..300).map(one).collect()
    }

    fn with_problem<T>(neurons: usize, check: impl FnOnce(&NetworkProblem, &[f64]) -> T) -> T {
        let counts = counts();
        let scaling = Scaling::of(&counts);
        let features = Features::new(&counts, &scaling);
        let distances_m: Vec<f64> = (0..300).map(|s| 0.1 + s as f64 / 600.0).collect();
        let weights: Vec<f64> = (0..300).map(|s| 500.0 + s as f64).collect();
        let problem = NetworkProblem {
            features: &features,
            scaling: &scaling,
            distances_m: &distances_m,
            weights: &weights,
            neurons,
            // Much, so that a fault in its derivatives shows.
            table_noise: 0.5,
            limits: Limits::default(),
        };
        let x: Vec<f64> = (0..parameters(neurons)).map(|k| (k as f64).sin() * 0.1).collect();
        check(&problem, &x)
    }

    /// Residuals of all samples, each with those of its neurons.
    fn residuals(problem: &NetworkProblem, x: &[f64]) -> Vec<f64> {
        let mut activations = vec![0.0; problem.neurons];
        let w2 = &x[problem.neurons * COLUMNS..];
        let mut residuals = Vec::new();
        for sample in 0..300 {
            let block = &problem.features.blocks()[sample / BLOCK];
            let depth = problem.depth(x, block, sample % BLOCK, &mut activations);
            let u = problem.weights[sample];
            residuals.push(u * (depth - problem.distances_m[sample]));
            for (a, w2) in activations.iter().zip(w2) {
                residuals.push(problem.table_noise * u * w2 * (1.0 - a * a));
            }
        }
        residuals
    }

    #[test]
    fn the_normal_equations_are_those_of_finite_differences() {
        for neurons in [1, 3] {
            with_problem(neurons, |problem, x| {
                let linear = problem.linearise(x);
                let cost = problem.cost(x);
                assert!((linear.cost - cost).abs() < 1e-12 * cost);
                let r = residuals(problem, x);
                let sum: f64 = r.iter().map(|r| r * r).sum();
                assert!((sum / 300.0 - cost).abs() < 1e-9 * cost);
                let column = |k: usize| -> Vec<f64> {
                    let mut moved = [x.to_vec(), x.to_vec()];
                    moved[0][k] += 1e-6;
                    moved[1][k] -= 1e-6;
                    let [above, below] = moved.map(|x| residuals(problem, &x));
                    above.iter().zip(&below).map(|(a, b)| (a - b) / 2e-6).collect()
                };
                let jacobian: Vec<Vec<f64>> = (0..x.len()).map(column).collect();
                let dot = |a: &[f64], b: &[f64]| -> f64 {
                    a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / 300.0
                };
                let norm: Vec<f64> =
                    jacobian.iter().map(|column| dot(column, column).sqrt()).collect();
                for (i, column) in jacobian.iter().enumerate() {
                    let (found, expected) = (linear.gradient[i], dot(column, &r));
                    assert!((found - expected).abs() < 1e-6 * norm[i] * cost.sqrt(), "{i}");
                    for j in 0..=i {
                        let (found, expected) = (linear.matrix.at(i, j), dot(column, &jacobian[j]));
                        assert!((found - expected).abs() < 1e-5 * norm[i] * norm[j], "{i} {j}");
                    }
                }
            });
        }
    }

    #[test]
    fn the_number_of_threads_changes_no_bit() {
        with_problem(3, |problem, x| {
            let result = |threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| (problem.cost(x), problem.linearise(x)))
            };
            assert!(result(1) == result(3));
        });
    }

    #[test]
    fn errors_are_depth_minus_distance() {
        with_problem(2, |problem, x| {
            let errors = problem.errors(x);
            let residuals = residuals(problem, x);
            for sample in [0, 255, 256, 299] {
                let expected = residuals[sample * 3] / problem.weights[sample];
                assert!((errors[sample] - expected).abs() < 1e-12);
            }
        });
    }
}
