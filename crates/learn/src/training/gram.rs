//! The expensive part of an epoch: sums over samples of a weight times products of two inputs.
//!
//! Block (k, l) of J'J is the sum of g_k g_l x x' over the samples x, so J is never formed: for all
//! pairs of neurons at once, every product of two inputs is made once and multiplied by the pairs'
//! weights. Within a block of samples sums are in single precision, over blocks in double. Each
//! sum has its own place in a register and takes its terms in order, without fused operations, so
//! that every processor gives the same bits.

use super::basis::LANES;
use super::features::{BLOCK, FeatureBlock, Tile, tile, tiles};

/// Weights that are worked on together.
pub const GROUP: usize = 12;
/// Column of the constant 1, in the last tile.
const ONE: usize = LANES - 1;

/// Weights of 256 samples, twelve pairs of neurons at a time: `weights[group][sample]`.
pub type BlockWeights = Vec<[[f32; GROUP]; BLOCK]>;

/// Sums for a group of weights and a column times a tile.
type Sums = [[f64; LANES]; GROUP];

/// Number of groups that hold `count` weights.
pub fn groups(count: usize) -> usize {
    count.div_ceil(GROUP)
}

/// Sums of weights times products of two inputs, so many places for each group of weights.
#[derive(Clone, Debug, PartialEq)]
struct Products {
    places: usize,
    /// `[group][place]`.
    sums: Vec<Sums>,
}

impl Products {
    /// Zeros for `count` weights.
    fn zeros(count: usize, places: usize) -> Self {
        Products { places, sums: vec![[[0.0; LANES]; GROUP]; groups(count) * places] }
    }

    /// The sum for a weight and a lane of a place.
    fn at(&self, weight: usize, place: usize, lane: usize) -> f64 {
        self.sums[weight / GROUP * self.places + place][weight % GROUP][lane]
    }

    /// Adds other sums.
    fn add(&mut self, other: &Self) {
        let sums = self.sums.as_flattened_mut().as_flattened_mut().iter_mut();
        let others = other.sums.as_flattened().as_flattened();
        sums.zip(others).for_each(|(sum, other)| *sum += other);
    }
}

/// Sums of weight times input times input, for many weights; a place is a column and a tile, each pair of
/// columns at least once.
#[derive(Clone, Debug, PartialEq)]
pub struct Gram(Products);

impl Gram {
    /// Zeros for `count` weights and so many tiles.
    pub fn zeros(count: usize, tiles: usize) -> Self {
        Gram(Products::zeros(count, LANES * tiles * (tiles + 1) / 2))
    }

    /// Adds other sums.
    pub fn add(&mut self, other: &Self) {
        self.0.add(&other.0);
    }

    /// Adds a block.
    #[inline(always)]
    pub fn add_block(&mut self, block: &FeatureBlock, weights: &BlockWeights) {
        let Products { places, sums } = &mut self.0;
        for (weights, sums) in weights.iter().zip(sums.chunks_mut(*places)) {
            let mut places = sums.iter_mut();
            for t in 0..tiles(block) {
                for column in 0..(t + 1) * LANES {
                    let Some(sums) = places.next() else { return };
                    let (of, lane) = (tile(block, column / LANES), column % LANES);
                    multiply(of, lane, tile(block, t), weights, sums);
                }
            }
        }
    }

    /// The sum for a weight and two columns.
    pub fn at(&self, weight: usize, row: usize, column: usize) -> f64 {
        let (row, column) = (row.max(column), row.min(column));
        let t = row / LANES;
        self.0.at(weight, LANES * t * (t + 1) / 2 + column, row % LANES)
    }
}

/// Sums of weight times input, for many weights; a place is a tile.
#[derive(Clone, Debug, PartialEq)]
pub struct Moments(Products);

impl Moments {
    /// Zeros for `count` weights and so many tiles.
    pub fn zeros(count: usize, tiles: usize) -> Self {
        Moments(Products::zeros(count, tiles))
    }

    /// Adds other sums.
    pub fn add(&mut self, other: &Self) {
        self.0.add(&other.0);
    }

    /// Adds a block.
    #[inline(always)]
    pub fn add_block(&mut self, block: &FeatureBlock, weights: &BlockWeights) {
        let Products { places, sums } = &mut self.0;
        let ones = tile(block, *places - 1);
        for (weights, sums) in weights.iter().zip(sums.chunks_mut(*places)) {
            for (t, sums) in sums.iter_mut().enumerate() {
                multiply(ones, ONE, tile(block, t), weights, sums);
            }
        }
    }

    /// The sum for a weight and a column.
    pub fn at(&self, weight: usize, column: usize) -> f64 {
        self.0.at(weight, column / LANES, column % LANES)
    }
}

/// Adds the sums over a block of twelve weights times a column times eight columns.
#[inline(always)]
fn multiply(of: &[Tile], lane: usize, by: &[Tile], weights: &[[f32; GROUP]; BLOCK], to: &mut Sums) {
    let mut sums = [[0.0f32; LANES]; GROUP];
    for ((of, by), weights) in of.iter().zip(by).zip(weights) {
        let factor = of[lane % LANES];
        let product: Tile = std::array::from_fn(|k| by[k] * factor);
        for group in 0..GROUP {
            for k in 0..LANES {
                sums[group][k] += weights[group] * product[k];
            }
        }
    }
    for (to, sums) in to.iter_mut().zip(&sums) {
        to.iter_mut().zip(sums).for_each(|(to, &sum)| *to += f64::from(sum));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::features::{InputScale, Scaling, blocks};

    #[test]
    fn sums_are_those_of_a_loop_over_the_samples() {
        let histogram = |s: usize| -> Vec<u32> {
            (0..256).map(|bin| ((s * 37 + bin * s) % 101) as u32).collect()
        };
        let counts: Vec<_> = (0..BLOCK).map(histogram).collect();
        let scaling = Scaling::of(&counts, &[], InputScale::Deviation);
        let block = &blocks(&counts, &scaling)[0];
        let weight = |s: usize, w: usize| ((s * 5 + w * 3) % 17) as f32 - 8.0;
        let mut weights = vec![[[0.0; GROUP]; BLOCK]; groups(14)];
        for (s, w) in (0..BLOCK).flat_map(|s| (0..14).map(move |w| (s, w))) {
            weights[w / GROUP][s][w % GROUP] = weight(s, w);
        }
        let (mut gram, mut moments) = (Gram::zeros(14, 9), Moments::zeros(14, 9));
        gram.add_block(block, &weights);
        moments.add_block(block, &weights);
        let once = gram.clone();
        gram.add(&once);
        let rows: Vec<_> = counts.iter().map(|counts| scaling.apply(counts)).collect();
        for w in [0, 11, 12, 13] {
            for (i, j) in [(0, 0), (3, 70), (70, 3), (64, 71), (71, 71), (9, 8)] {
                let term = |(s, x): (usize, &Vec<f32>)| f64::from(weight(s, w) * x[i] * x[j]);
                let expected: f64 = rows.iter().enumerate().map(term).sum();
                let found = gram.at(w, i, j) / 2.0;
                assert!((found - expected).abs() < 1e-2, "{w} {i} {j}: {found} {expected}");
                if j == 71 {
                    assert!((moments.at(w, i) - expected).abs() < 1e-2);
                }
            }
        }
    }
}
