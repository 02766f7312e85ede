//! Histograms with their true distances: what a network is trained and judged on.

use tofsim::error::Input;
use tofsim::files::digest::digest;
use tofsim::network::Histogram;

use crate::dataset::grid::DISTANCE;
use crate::dataset::{Grid, HistogramSource, Rows, Subset};
use crate::estimation::acquisition::{ARRIVAL_PS_PER_M, BIN_PS};

use super::basis::knots_between;
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

/// Scenes of the thesis's test grid: as many as are drawn for a test or a choice at most.
const MOST_SCENES: u64 = 51 * 477;
/// Distances of the thesis's test grid: as many as another one has at most.
const TEST_DISTANCES: usize = 51;

/// Where the histograms of a training come from.
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

    /// Draws what a training has for a purpose, equally many histograms at each distance.
    pub fn draw(&self, recipe: &Recipe, seed: u64, purpose: Purpose) -> Samples {
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
        let mut samples = Samples::default();
        for sample in source.blocks(&rows, seed).flatten() {
            samples.counts.push(sample.histogram);
            samples.distances_m.push(sample.scene.distance_m);
        }
        samples
    }

    /// Places of the knots for these distances; none are the thesis's.
    pub fn knots(&self) -> Vec<f64> {
        if self.training.is_thesis() {
            return Vec::new();
        }
        let bins = self.training.distances_m.range().map(|m| m * ARRIVAL_PS_PER_M / BIN_PS);
        knots_between(bins).to_vec()
    }

    /// That there are several distances, and histograms for each in every stage.
    ///
    /// # Errors
    /// Naming what is too few.
    pub fn check(&self, recipe: &Recipe) -> Result<(), Input> {
        let distances = self.training.distances_m.count();
        let fault = |field: &str, value: u64, expected: String| {
            Err(Input::new("recipe", expected).field(field).value(value))
        };
        if distances < 2 {
            let expected = "one value, expected two distances at least to train a network for";
            return Err(Input::new("--grid", expected).field(DISTANCE));
        }
        let expected = || format!("expected {distances} or more, the grid's distances");
        for place in 0..=recipe.stages.len() {
            let samples = recipe.stage(place).samples;
            let is_finish = place == recipe.stages.len();
            let name = if is_finish { "finish".to_owned() } else { format!("stages[{place}]") };
            if samples < distances {
                return fault(&format!("{name}.samples"), samples, expected());
            }
        }
        match recipe.validation {
            validation if validation > 0 && validation < distances => {
                fault("validation", validation, expected())
            }
            _ => Ok(()),
        }
    }
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
    use crate::dataset::{Axis, GridPurpose};
    use tofsim::scenario;
    use tofsim::sim::setup::Setup;

    fn scenes<'a>(source: &'a HistogramSource, option: &str) -> TrainingScenes<'a> {
        let axes = [Axis::parse("--grid", option).unwrap()];
        let grid = |purpose| Grid::own(&axes, source.scenario(), purpose).unwrap();
        let [training, test] = [GridPurpose::Training, GridPurpose::Test].map(grid);
        TrainingScenes::of_grids(source, training, test)
    }

    fn source() -> HistogramSource {
        let few = ["firmware.shots_per_frame=300".to_owned()];
        HistogramSource::new(&Setup::new(scenario::load("kc705", &few).unwrap()).unwrap()).unwrap()
    }

    #[test]
    fn an_own_grid_is_trained_tested_and_chosen_on_with_draws_of_their_own() {
        let source = source();
        let scenes = scenes(&source, "target.distance_m=0.05..0.9:0.0025");
        assert_eq!((scenes.training.scenes(), scenes.test.scenes()), (341, 35));
        let recipe = Recipe::quick();
        let [test, choice, stage] = [Purpose::Test, Purpose::Choice, Purpose::Stage(0)]
            .map(|purpose| scenes.draw(&recipe, 1, purpose));
        assert_eq!((test.counts.len(), choice.counts.len(), stage.counts.len()), (35, 35, 603));
        assert_eq!((test.distances_m[0], test.distances_m[34]), (0.05, 0.9));
        assert!(test.distances_m.iter().all(|d| stage.distances_m.contains(d)));
        let shared = |a: &Samples, b: &Samples| a.counts.iter().any(|one| b.counts.contains(one));
        assert!(!shared(&test, &stage) && !shared(&test, &choice) && !shared(&choice, &stage));
        assert!(scenes.knots()[60] > 200.0);
    }

    #[test]
    fn the_thesis_s_grids_are_as_they_were() {
        let source = source();
        let thesis = TrainingScenes::thesis(&source);
        let of = TrainingScenes::of_grids(&source, Grid::training(), Grid::test());
        assert_eq!((of.training, of.test), (thesis.training.clone(), thesis.test.clone()));
        assert!(thesis.knots().is_empty());
    }

    #[test]
    fn too_few_distances_or_histograms_are_refused() {
        let source = source();
        let check = |option: &str, recipe: &Recipe| {
            scenes(&source, option).check(recipe).err().map(|error| error.to_string())
        };
        assert_eq!(check("target.distance_m=0.1..0.6:0.0025", &Recipe::quick()), None);
        let one = check("target.reflectance=0.1,0.2", &Recipe::quick()).unwrap();
        assert!(one.contains("target.distance_m: one value, expected two"), "{one}");
        let many = check("target.distance_m=0.1..0.9:0.001", &Recipe::quick()).unwrap();
        assert!(many.contains("stages[0].samples = 603: expected 801 or more"), "{many}");
    }

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
