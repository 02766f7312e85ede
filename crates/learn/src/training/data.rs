//! Samples of a training, drawn for one purpose.

use crate::dataset::{Grid, HistogramSource, Rows, Subset};

use super::features::{Features, Scaling};
use super::network_problem::NetworkProblem;
use super::recipe::Recipe;
use super::samples::{Samples, digest};
use super::start::{Purpose, derived};

/// Draws `len` histograms, equally many at each distance.
pub fn draw(
    source: &HistogramSource,
    grid: Grid,
    len: u64,
    seed: u64,
    purpose: Purpose,
) -> Samples {
    let seed = derived(seed, purpose);
    let rows = Rows::Subset(Subset::new(grid, len, seed));
    let mut samples = Samples::default();
    for sample in source.blocks(&rows, seed, 0..len).flatten() {
        samples.counts.push(sample.histogram);
        samples.distances_m.push(sample.scene.distance_m);
    }
    samples
}

/// Histograms that a stage trains on, or after all stages the end.
pub fn stage_samples(
    recipe: &Recipe,
    source: &HistogramSource,
    seed: u64,
    stage: usize,
) -> Samples {
    let samples = recipe.stage(stage).samples;
    draw(source, Grid::training(), samples, seed, Purpose::Stage(stage))
}

/// Histograms of the validation stop, if it is wanted.
pub fn held_out(recipe: &Recipe, source: &HistogramSource, seed: u64) -> Option<Samples> {
    let len = recipe.validation;
    (len > 0).then(|| draw(source, Grid::training(), len, seed, Purpose::Validation))
}

/// Histograms that the best block is chosen by, so many for each scene of the test grid.
pub fn choice_samples(recipe: &Recipe, source: &HistogramSource, seed: u64) -> Samples {
    let grid = Grid::test();
    let scenes = grid.distances_m.count * grid.lights();
    draw(source, grid, recipe.finish.choice * scenes, seed, Purpose::Choice)
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
    pub features: Features,
    /// True distances [m].
    pub distances_m: Vec<f64>,
    /// Digest of the histograms and distances.
    pub digest: u64,
}

impl StageData {
    /// Of samples; `scaling` is that of the first stage.
    pub fn new(samples: &Samples, scaling: &Scaling) -> Self {
        StageData {
            features: Features::new(&samples.counts, scaling),
            distances_m: samples.distances_m.clone(),
            digest: samples.digest(),
        }
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
            features: &self.features,
            scaling,
            distances_m: &self.distances_m,
            weights,
            neurons: recipe.neurons,
            table_noise: recipe.table_noise * recipe.formats.step(),
            hinges: recipe.limits.hinges(&recipe.formats),
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
