//! Histograms with their true distances: what a network is trained and judged on.

use tofsim::network::Histogram;

use crate::dataset::{Grid, HistogramSource, Rows, Subset};

use super::features::{FeatureBlock, Scaling, blocks};
use super::limits::Hinges;
use super::network_problem::NetworkProblem;
use super::recipe::Recipe;
use super::start::derived;

/// Histograms and distances, one of each a sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// Counts by bin [hits].
    pub counts: Vec<Histogram>,
    /// True distance [m].
    pub distances_m: Vec<f64>,
}

impl Samples {
    /// A number that changes with any count and any distance.
    pub fn digest(&self) -> u64 {
        let mut value = digest(0, &[]);
        for (counts, distance_m) in self.counts.iter().zip(&self.distances_m) {
            value = digest(value, &distance_m.to_le_bytes());
            value = counts.iter().fold(value, |value, count| digest(value, &count.to_le_bytes()));
        }
        value
    }
}

/// FNV-1a of 64 bits, going on from `before`.
pub(super) fn digest(before: u64, bytes: &[u8]) -> u64 {
    let start = before ^ 0xcbf2_9ce4_8422_2325;
    bytes
        .iter()
        .fold(start, |value, &byte| (value ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// What histograms are drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The best block is chosen by them.
    Choice,
    /// The accuracy in the file.
    Test,
    /// The validation stop.
    Validation,
    /// A stage; the end is the last one.
    Stage(usize),
}

/// Draws what a training has for a purpose, equally many histograms at each distance.
pub fn draw(recipe: &Recipe, source: &HistogramSource, seed: u64, purpose: Purpose) -> Samples {
    let (training, test) = (Grid::training(), Grid::test());
    let scenes = test.scenes();
    let (place, grid, len) = match purpose {
        Purpose::Choice => (2, test, recipe.finish.choice * scenes),
        Purpose::Test => (3, test, scenes),
        Purpose::Validation => (4, training, recipe.validation),
        Purpose::Stage(stage) => (16 + stage as u64, training, recipe.stage(stage).samples),
    };
    let seed = derived(seed, place);
    let rows = Rows::Subset(Subset::new(grid, len, seed));
    let mut samples = Samples::default();
    for sample in source.blocks(&rows, seed).flatten() {
        samples.counts.push(sample.histogram);
        samples.distances_m.push(sample.scene.distance_m);
    }
    samples
}

/// A number that changes with the chain's bins and anything in the scenario.
pub fn fingerprint(source: &HistogramSource) -> String {
    let text = format!("{:?} {:?}", source.scenario(), source.bins());
    format!("{:016x}", digest(0, text.as_bytes()))
}

/// The data of a stage as the optimiser wants them.
#[derive(Clone, Debug)]
pub struct StageData {
    /// Inputs.
    pub blocks: Vec<FeatureBlock>,
    /// True distances [m].
    pub distances_m: Vec<f64>,
}

impl StageData {
    /// Of samples; `scaling` is that of the first stage.
    pub fn new(samples: Samples, scaling: &Scaling) -> Self {
        let Samples { counts, distances_m } = samples;
        StageData { blocks: blocks(&counts, scaling), distances_m }
    }

    /// What a network is trained on: these samples with their weights, and others that are held out.
    pub fn problem<'a>(
        &'a self,
        recipe: &Recipe,
        scaling: &'a Scaling,
        weights: &'a [f64],
        held_out: Option<&'a NetworkProblem<'a>>,
    ) -> NetworkProblem<'a> {
        NetworkProblem {
            blocks: &self.blocks,
            scaling,
            distances_m: &self.distances_m,
            weights,
            neurons: recipe.neurons,
            table_noise: recipe.table_noise * recipe.formats.step(),
            hinges: Hinges { limits: recipe.limits, words: recipe.formats },
            held_out,
        }
    }

    /// Weights of all samples. They are ordered by distance, each distance with a factor, 1 where there is
    /// none.
    pub fn weights(&self, recipe: &Recipe, factors: &[f64]) -> Vec<f64> {
        let mut weights = Vec::with_capacity(self.distances_m.len());
        for (place, same) in self.distances_m.chunk_by(|a, b| a == b).enumerate() {
            let factor = factors.get(place).copied().unwrap_or(1.0);
            let weight = factor * recipe.weighting.weight(same[0]);
            weights.resize(weights.len() + same.len(), weight);
        }
        weights
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digest_sees_every_count_and_distance() {
        let samples = Samples { counts: vec![[7; 256]; 2], distances_m: vec![0.1, 0.2] };
        let mut other = samples.clone();
        other.counts[1][255] += 1;
        assert_ne!(samples.digest(), other.digest());
        let mut other = samples.clone();
        other.distances_m[0] = 0.1f64.next_up();
        assert_ne!(samples.digest(), other.digest());
        assert_eq!(samples.digest(), samples.clone().digest());
    }
}
