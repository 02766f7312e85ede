//! The network's error as a sum of squares, with its derivatives.
//!
//! A sample has the residual u (depth - distance), where u is its weight, and, for the noise that the
//! activation table's steps are, a residual q u w2 (1 - a^2) for each neuron: an error of q in the
//! sum of a neuron would move the depth by so much. The latter belong to one neuron alone, so they
//! only change the weights of the sums in [`super::gram`].

use std::ops::Range;

use rayon::prelude::*;

use super::basis::LANES;
use super::features::{BLOCK, FeatureBlock, Scaling, tile};
use super::gram::{BlockWeights, GROUP, groups};
use super::limits::Hinges;
use super::lm::{NormalEquations, Problem};
use super::sums::Sums;

/// Blocks that a thread sums up at a time. Fixed, as the order of sums is.
const RUN: usize = 8;

/// Samples, their weights, and what else is to be small.
#[derive(Debug)]
pub struct NetworkProblem<'a> {
    /// Inputs.
    pub blocks: &'a [FeatureBlock],
    /// Scaling of the inputs.
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
    pub hinges: Hinges,
    /// The same over data that no step is made from.
    pub held_out: Option<&'a NetworkProblem<'a>>,
}

/// Weights of a block's samples in the sums.
struct Scratch {
    pairs: BlockWeights,
    cross: BlockWeights,
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
    fn sum(block: &FeatureBlock, sample: usize, row: &[f64]) -> f64 {
        let mut sums = [0.0; LANES];
        for (t, weights) in row.chunks_exact(LANES).enumerate() {
            let inputs = &tile(block, t)[sample];
            for lane in 0..LANES {
                sums[lane] += weights[lane] * f64::from(inputs[lane]);
            }
        }
        sums.iter().sum()
    }

    /// Samples of a block.
    fn samples(&self, index: usize) -> Range<usize> {
        index * BLOCK..self.distances_m.len().min((index + 1) * BLOCK)
    }

    /// Depth of a sample; leaves the neurons' outputs in `activations` [m].
    #[inline(always)]
    fn depth(
        &self,
        x: &[f64],
        block: &FeatureBlock,
        sample: usize,
        activations: &mut [f64],
    ) -> f64 {
        let columns = self.scaling.columns();
        let output = &x[self.neurons * columns..];
        let mut depth = output[self.neurons];
        for (k, activation) in activations.iter_mut().enumerate() {
            *activation = libm::tanh(Self::sum(block, sample, &x[k * columns..][..columns]));
            depth += output[k] * *activation;
        }
        depth
    }

    /// Squares of a block's residuals.
    #[inline(always)]
    fn block_cost(&self, x: &[f64], index: usize, activations: &mut [f64]) -> f64 {
        let (block, w2) = (&self.blocks[index], &x[self.neurons * self.scaling.columns()..]);
        let mut cost = 0.0;
        for (place, sample) in self.samples(index).enumerate() {
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
        let (n, columns) = (self.neurons, self.scaling.columns());
        let (block, w2) = (&self.blocks[index], &x[n * columns..]);
        let samples = self.samples(index);
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
                let gradient = &mut sums.gradient[k * columns..][..columns];
                for (t, gradient) in gradient.chunks_exact_mut(LANES).enumerate() {
                    let inputs = &tile(block, t)[place];
                    for lane in 0..LANES {
                        gradient[lane] += along * f64::from(inputs[lane]);
                    }
                }
                sums.gradient[n * columns + k] += by_w2 * noise;
                sums.corner[k * (n + 1) + k] += by_w2 * by_w2;
            }
            for (k, output) in outputs.iter().enumerate() {
                sums.gradient[n * columns + k] += output * residual;
                for (l, other) in outputs.iter().enumerate() {
                    sums.corner[k * (n + 1) + l] += output * other;
                }
            }
        }
        sums.gram.add_block(block, &scratch.pairs);
        sums.cross.add_block(block, &scratch.cross);
    }

    /// Applies `add_up` to each run of neighbouring blocks, in order, with vectors as wide as `arch` allows; threads
    /// share the runs. Loops in it are plain ones: the body of a `fold` or a `for_each` may become a separate
    /// function, which has narrow vectors.
    fn each_run<T: Send>(
        &self,
        arch: pulp::Arch,
        add_up: impl Fn(Range<usize>) -> T + Sync,
    ) -> Vec<T> {
        let blocks = self.blocks.len();
        let run = |place: usize| {
            let run = place * RUN..blocks.min((place + 1) * RUN);
            arch.dispatch(
                #[inline(always)]
                || add_up(run),
            )
        };
        (0..blocks.div_ceil(RUN)).into_par_iter().map(run).collect()
    }

    /// Squares of the residuals, run by run.
    fn squares(&self, arch: pulp::Arch, x: &[f64]) -> Vec<f64> {
        self.each_run(
            arch,
            #[inline(always)]
            |run| {
                let (mut cost, mut activations) = (0.0, vec![0.0; self.neurons]);
                for index in run {
                    cost += self.block_cost(x, index, &mut activations);
                }
                cost
            },
        )
    }

    /// Computes the sums over the samples, run by run.
    fn sums(&self, arch: pulp::Arch, x: &[f64]) -> Vec<Sums> {
        self.each_run(
            arch,
            #[inline(always)]
            |run| {
                let mut scratch = Scratch::new(self.neurons);
                let mut sums = Sums::zeros(self.neurons, self.scaling.columns());
                for index in run {
                    self.add_block(x, index, &mut scratch, &mut sums);
                }
                sums
            },
        )
    }

    /// Mean square of the residuals, without penalties.
    fn mean_square(&self, x: &[f64]) -> f64 {
        let squares = self.squares(pulp::Arch::new(), x);
        squares.iter().sum::<f64>() / self.distances_m.len() as f64
    }

    /// Depth minus distance of each sample [m].
    pub fn errors(&self, x: &[f64]) -> Vec<f64> {
        let error = |(sample, distance_m): (usize, &f64)| {
            let mut activations = vec![0.0; self.neurons];
            let block = &self.blocks[sample / BLOCK];
            self.depth(x, block, sample % BLOCK, &mut activations) - distance_m
        };
        self.distances_m.par_iter().enumerate().map(error).collect()
    }
}

impl Problem for NetworkProblem<'_> {
    fn cost(&self, x: &[f64]) -> f64 {
        self.mean_square(x) + self.hinges.cost(x, self.neurons, self.scaling)
    }

    fn validation(&self, x: &[f64]) -> Option<f64> {
        self.held_out.map(|held_out| held_out.mean_square(x))
    }

    fn linearise(&self, x: &[f64]) -> NormalEquations {
        let parts = self.sums(pulp::Arch::new(), x);
        let sums = parts.iter().fold(Sums::zeros(self.neurons, self.scaling.columns()), Sums::with);
        let mut linear = sums.assemble(self.neurons, self.distances_m.len());
        self.hinges.add(x, self.neurons, self.scaling, &mut linear);
        linear
    }
}

#[cfg(test)]
mod tests;
