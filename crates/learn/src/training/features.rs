//! Inputs of the optimiser: counts at the knots, centred and scaled.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use tofsim::firmware::histogram_builder::BINS;
use tofsim::network::Histogram;

use super::basis::{Basis, LANES};

/// Samples that are worked on together.
pub const BLOCK: usize = 256;

/// Some columns of a sample.
pub type Tile = [f32; LANES];

/// Scaling of counts at knots to inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scaling {
    /// Value of each knot that is an input of 0 [hits].
    pub centre: Vec<f64>,
    /// One over what is an input of 1 beside it; 0 where nothing varies, so that the input is
    /// 0 as well [1/hits].
    pub inverse_scale: Vec<f64>,
    /// Places of the knots, one less than whole tiles have columns; none are the thesis's [bins].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub knots: Vec<f64>,
    /// Bins of the histograms.
    #[serde(default = "usual_bins")]
    pub bins: usize,
}

fn usual_bins() -> usize {
    BINS
}

impl Default for Scaling {
    /// Of nothing yet.
    fn default() -> Self {
        Scaling { centre: Vec::new(), inverse_scale: Vec::new(), knots: Vec::new(), bins: BINS }
    }
}

/// By what the inputs are scaled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InputScale {
    /// Their standard deviation about the mean.
    #[default]
    Deviation,
    /// Their range: the least is -1 and the largest 1, as MATLAB's `mapminmax` has it.
    Range,
}

impl Scaling {
    /// Of the histograms given, with knots at these places, or at the thesis's.
    pub fn of(counts: &[Histogram], knots: &[f64], scale: InputScale) -> Self {
        let bins = counts.first().map_or(BINS, Vec::len);
        let basis = Basis::new(knots, bins);
        let [centre, inverse_scale] = match scale {
            InputScale::Deviation => deviations(counts, &basis),
            InputScale::Range => ranges(counts, &basis),
        };
        Scaling { centre, inverse_scale, knots: knots.to_vec(), bins }
    }

    /// The basis of its knots.
    pub fn basis(&self) -> Basis {
        Basis::new(&self.knots, self.bins)
    }

    /// Inputs of a sample: one for each knot, and a constant 1 for the bias.
    pub fn columns(&self) -> usize {
        self.centre.len() + 1
    }

    /// Inputs of a histogram, and a 1.
    pub fn apply(&self, counts: &[u32]) -> Vec<f32> {
        self.apply_on(&self.basis(), counts)
    }

    /// The same where the basis of its knots is known.
    fn apply_on(&self, basis: &Basis, counts: &[u32]) -> Vec<f32> {
        let scales = self.centre.iter().zip(&self.inverse_scale);
        let input = |(knot, (centre, scale)): (f64, (&f64, &f64))| (knot - centre) * scale;
        let inputs = basis.gather(counts).into_iter().zip(scales).map(input);
        inputs.map(|input| input as f32).chain([1.0]).collect()
    }
}

/// Mean and one over the standard deviation at each knot.
fn deviations(counts: &[Histogram], basis: &Basis) -> [Vec<f64>; 2] {
    let n = counts.len().max(1) as f64;
    let mut mean = vec![0.0; basis.knots()];
    let add = |sums: &mut [f64], term: &dyn Fn(usize, f64) -> f64| {
        for histogram in counts {
            let knots = basis.gather(histogram);
            sums.iter_mut().enumerate().for_each(|(k, sum)| *sum += term(k, knots[k]) / n);
        }
    };
    add(&mut mean, &|_, x| x);
    let mut variance = vec![0.0; basis.knots()];
    add(&mut variance, &|k, x| (x - mean[k]) * (x - mean[k]));
    // Rounding leaves a constant a little to vary.
    let inverse = |(variance, mean): (&f64, &f64)| {
        if *variance > 1e-20 * (1.0 + mean * mean) { 1.0 / variance.sqrt() } else { 0.0 }
    };
    let inverse_scale = variance.iter().zip(&mean).map(inverse).collect();
    [mean, inverse_scale]
}

/// Middle and one over half the range at each knot.
fn ranges(counts: &[Histogram], basis: &Basis) -> [Vec<f64>; 2] {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let mut ends = vec![none; basis.knots()];
    for histogram in counts {
        for ((least, most), knot) in ends.iter_mut().zip(basis.gather(histogram)) {
            (*least, *most) = (least.min(knot), most.max(knot));
        }
    }
    let middle = ends.iter().map(|(least, most)| (least + most) / 2.0).collect();
    let inverse = |(least, most): &(f64, f64)| {
        if most > least { 2.0 / (most - least) } else { 0.0 }
    };
    [middle, ends.iter().map(inverse).collect()]
}

/// Inputs of 256 samples, a tile after the other: `block[tile][sample]`.
pub type FeatureBlock = Vec<Tile>;

/// Inputs of histograms, in blocks, of which the last ends in zeros.
pub fn blocks(counts: &[Histogram], scaling: &Scaling) -> Vec<FeatureBlock> {
    let basis = scaling.basis();
    let block = |counts: &[Histogram]| {
        let mut block = vec![[0.0; LANES]; scaling.columns() / LANES * BLOCK];
        for (sample, histogram) in counts.iter().enumerate() {
            for (tile, columns) in scaling.apply_on(&basis, histogram).chunks(LANES).enumerate() {
                block[tile * BLOCK + sample].copy_from_slice(columns);
            }
        }
        block
    };
    counts.chunks(BLOCK).map(block).collect()
}

/// Groups of columns of a block.
#[inline(always)]
pub fn tiles(block: &FeatureBlock) -> usize {
    block.len() / BLOCK
}

/// The samples of a tile in a block.
#[inline(always)]
pub fn tile(block: &FeatureBlock, tile: usize) -> &[Tile] {
    &block[tile * BLOCK..(tile + 1) * BLOCK]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::basis::KNOTS;

    #[test]
    fn inputs_have_mean_0_and_standard_deviation_1() {
        let histogram = |s: usize| -> Histogram {
            (0..256).map(|bin| ((s * 37 + bin * s) % 101) as u32).collect()
        };
        let counts: Vec<_> = (0..300).map(histogram).collect();
        let scaling = Scaling::of(&counts, &[], InputScale::Deviation);
        for k in 1..KNOTS {
            let inputs = counts.iter().map(|counts| f64::from(scaling.apply(counts)[k]));
            let (sum, squares) = inputs.fold((0.0, 0.0), |(sum, sq), x| (sum + x, sq + x * x));
            assert!((sum / 300.0).abs() < 1e-5, "{k}");
            assert!((squares / 300.0 - 1.0).abs() < 1e-5, "{k}");
        }
    }

    #[test]
    fn inputs_by_range_reach_from_minus_1_to_1() {
        let counts: Vec<Histogram> =
            [3, 11, 5].map(|hits| (0..256).map(|bin| hits * (bin + 1)).collect()).to_vec();
        let scaling = Scaling::of(&counts, &[], InputScale::Range);
        let inputs = counts.iter().map(|counts| scaling.apply(counts)).collect::<Vec<_>>();
        for (inputs, expected) in inputs.iter().zip([-1.0, 1.0, -0.5]) {
            let close = |input: &f32| (input - expected).abs() < 1e-6;
            assert!(inputs[..KNOTS - 1].iter().all(close), "{expected}: {inputs:?}");
        }
    }

    #[test]
    fn a_constant_bin_gives_0() {
        let counts = vec![vec![1234; 256]; 3];
        for scale in [InputScale::Deviation, InputScale::Range] {
            let scaling = Scaling::of(&counts, &[], scale);
            assert_eq!(scaling.inverse_scale, vec![0.0; KNOTS]);
            assert_eq!(scaling.apply(&counts[0])[..KNOTS], [0.0; KNOTS]);
            assert_eq!(scaling.apply(&[7; 256])[KNOTS], 1.0);
        }
    }

    #[test]
    fn the_last_block_ends_in_zeros() {
        let counts = vec![vec![1; 256]; BLOCK + 2];
        let blocks = blocks(&counts, &Scaling::of(&counts, &[], InputScale::Deviation));
        assert_eq!(blocks.len(), 2);
        let last = tile(&blocks[1], tiles(&blocks[1]) - 1);
        assert_eq!(last[1][LANES - 1], 1.0);
        assert!(last[2..].iter().all(|columns| *columns == [0.0; LANES]));
    }
}
