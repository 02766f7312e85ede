//! Histograms with their true distances: what a network is trained and judged on.

use std::fmt;

use tofsim::error::Input;
use tofsim::files::digest::digest;
use tofsim::network::Histogram;
use tofsim::optics::Bins;

use crate::dataset::grid::DISTANCE;
use crate::dataset::{Grid, HistogramSource, Rows, Subset};
use crate::estimation::acquisition::ARRIVAL_PS_PER_M;

use super::basis::{Echoes, knots_for};
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
            value = counts.iter().fold(value, |value, count| {
                // Words of 16 bits as such, so that more room for wider ones changes no number.
                let bytes = if *count >> 16 == 0 { 2 } else { 4 };
                digest(value, &count.to_le_bytes()[..bytes])
            });
        }
        value
    }
}

/// Purpose of histograms.
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

/// Scenes of the thesis's test grid: as many as are drawn for a test or a choice at most.
const MOST_SCENES: u64 = 51 * 477;
/// Distances of the thesis's test grid: as many as another one has at most.
const TEST_DISTANCES: usize = 51;

/// When the photons of an echo come, beside their flight.
#[derive(Clone, Copy, Debug)]
pub struct PulseTimes {
    /// Delay of the light after the laser edge [ps].
    pub delay_ps: f64,
    /// Standard deviation of the pulse [ps].
    pub sigma_ps: f64,
}

/// Source of the histograms of a training.
pub trait TrainingMaterial: fmt::Debug + Sync {
    /// Draws a training's samples for a purpose, in order of distance.
    fn draw(&self, recipe: &Recipe, seed: u64, purpose: Purpose) -> Samples;

    /// Distances of the training, in rising order [m].
    fn distances_m(&self) -> &[f64];

    /// Places of the knots for these distances, so many if the recipe says; none are the thesis's.
    fn knots(&self, recipe: &Recipe) -> Vec<f64> {
        let bins = self.bins();
        knots_for(&echoes(self.distances_m(), bins, self.pulse_times()), bins.count(), recipe.knots)
    }

    /// Delay and width of the pulse, in the first of the settings.
    fn pulse_times(&self) -> PulseTimes;

    /// Returns the times of each code, in the first of the settings.
    fn bins(&self) -> &Bins;

    /// Checks that there are several distances, and histograms for each in every stage.
    ///
    /// # Errors
    /// Naming what is too few.
    fn check(&self, recipe: &Recipe) -> Result<(), Input> {
        let distances = self.distances_m().len() as u64;
        if distances < 2 {
            let expected = "one value, expected two distances at least to train a network for";
            return Err(Input::new("--grid", expected).field(DISTANCE));
        }
        let stages = (0..=recipe.stages.len()).map(|place| {
            let is_finish = place == recipe.stages.len();
            let name = if is_finish { "finish".to_owned() } else { format!("stages[{place}]") };
            (format!("{name}.samples"), recipe.stage(place).samples)
        });
        let validation =
            (recipe.validation > 0).then_some(("validation".to_owned(), recipe.validation));
        match stages.chain(validation).find(|(_, samples)| *samples < distances) {
            None => Ok(()),
            Some((field, samples)) => {
                let expected = format!("expected {distances} or more, the number of distances");
                Err(Input::new("recipe", expected).field(field).value(samples))
            }
        }
    }
}

/// Scenes on grids, whose histograms are drawn.
#[derive(Clone, Debug)]
pub struct TrainingScenes<'a> {
    source: &'a HistogramSource,
    /// For training and its validation.
    pub training: Grid,
    /// For the test and the choice.
    pub test: Grid,
}

impl<'a> TrainingScenes<'a> {
    /// The thesis's grids.
    pub fn thesis(source: &'a HistogramSource) -> Self {
        TrainingScenes { source, training: Grid::training(), test: Grid::test() }
    }

    /// The same scenes for training and for tests, with other draws, and fewer distances for tests. The
    /// thesis's training grid so comes to its test grid.
    pub fn of_grids(source: &'a HistogramSource, training: Grid, test: Grid) -> Self {
        TrainingScenes { source, training, test: test.with_distances(TEST_DISTANCES) }
    }
}

impl TrainingMaterial for TrainingScenes<'_> {
    fn distances_m(&self) -> &[f64] {
        &self.training.distances_m.values
    }

    fn bins(&self) -> &Bins {
        self.source.acquisition(0).bins
    }

    fn knots(&self, recipe: &Recipe) -> Vec<f64> {
        let bins = self.bins();
        if self.training.is_thesis() && bins.are_kc705() && recipe.knots.is_none() {
            return Vec::new();
        }
        knots_for(&echoes(self.distances_m(), bins, self.pulse_times()), bins.count(), recipe.knots)
    }

    fn pulse_times(&self) -> PulseTimes {
        let acquisition = self.source.acquisition(0);
        PulseTimes { delay_ps: acquisition.delay_ps, sigma_ps: acquisition.pulse.sigma_ps() }
    }

    /// Equally many histograms at each distance.
    fn draw(&self, recipe: &Recipe, seed: u64, purpose: Purpose) -> Samples {
        let TrainingScenes { source, training, test } = self;
        let scenes = test.scenes().min(MOST_SCENES);
        let (place, grid, len) = match purpose {
            Purpose::Choice => (2, test, recipe.finish.choice * scenes),
            Purpose::Test => (3, test, scenes),
            Purpose::Validation => (4, training, recipe.validation),
            Purpose::Stage(stage) => (16 + stage as u64, training, recipe.stage(stage).samples),
        };
        let seed = derived(seed, place);
        let rows = Rows::Subset(Subset::new(grid.clone(), len, seed));
        let drawn = source.blocks(&rows, seed).flatten();
        let (counts, distances_m) =
            drawn.map(|sample| (sample.histogram, sample.scene.distance_m)).unzip();
        Samples { counts, distances_m }
    }
}

/// Returns the expected places of the echoes of distances in ascending order.
fn echoes(distances_m: &[f64], bins: &Bins, pulse: PulseTimes) -> Echoes {
    let ends = [distances_m.first(), distances_m.last()];
    let arrival_ps = |m: f64| pulse.delay_ps + m * ARRIVAL_PS_PER_M;
    let places = ends.map(|m| bins.place(arrival_ps(m.copied().unwrap_or_default())));
    Echoes { places, sigma: bins.place(pulse.sigma_ps) - bins.place(0.0) }
}

/// A number that changes with the chain's bins and anything in the scenario, or in one of a grid's.
pub fn fingerprint(source: &HistogramSource) -> String {
    let mut value = 0;
    for (setting, scenario) in source.scenarios().enumerate() {
        let text = format!("{:?} {:?}", scenario, source.acquisition(setting).bins);
        value = digest(value, text.as_bytes());
    }
    format!("{value:016x}")
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

    /// Creates the training problem of a network: weighted samples, and others that are held out.
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
mod tests;
