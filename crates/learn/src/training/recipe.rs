//! The recipe of a training: every number that decides what comes out, but for the seed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use tofsim::firmware::forward2::NEURONS;

use tofsim::firmware::depth_estimator::datapath::Datapath;

use super::features::InputScale;
use super::limits::WordLimits;
use super::lm::LmSettings;
use super::weighting::Weighting;

mod check;
mod read;

/// Recipe of a network's training.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Recipe {
    /// Hidden neurons.
    pub neurons: usize,
    /// Epochs between two checkpoints.
    pub checkpoint_epochs: u64,
    /// Part of its cost that a network has to lose from a checkpoint to the next, or it rests until
    /// the next stage or block; with 0 it rests only when no step helps [1].
    pub least_gain: f64,
    /// Histograms for a validation stop, drawn for that: a network rests until the next stage or block
    /// when its error on them has not fallen for `optimiser.max_fail` epochs, and goes back to where it
    /// was least; with 0 there is none.
    pub validation: u64,
    /// Knots between which the hidden weights are straight: a multiple of 8 less one. Without it there are as
    /// many as the width of the pulse asks for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub knots: Option<usize>,
    /// By what the inputs are scaled.
    pub inputs: InputScale,
    /// Noise of a neuron's sum from the activation table's steps [steps].
    pub table_noise: f64,
    /// Random starts.
    pub start: RandomStart,
    /// The tournament: each stage goes on with the best of the one before.
    pub stages: Vec<Stage>,
    /// Treatment of the winner.
    pub finish: Finish,
    /// Weights of the residuals.
    pub weighting: Weighting,
    /// Words that it is to fit, and the table of activations.
    pub formats: Datapath,
    /// Penalties for what the words cannot hold.
    pub limits: WordLimits,
    /// The optimiser.
    pub optimiser: LmSettings,
}

/// Random weights to begin with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RandomStart {
    /// Lengths of a neuron's weights for inputs in standard deviations; starts take them in turn.
    pub lengths: Vec<f64>,
    /// Biases are spread evenly from minus this to this.
    pub bias: f64,
    /// Output weights are uniform from minus this to this [m].
    pub output_m: f64,
}

/// A stage of the tournament.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Networks that take part.
    pub candidates: usize,
    /// Epochs for each.
    pub epochs: u64,
    /// Histograms, drawn for this stage.
    pub samples: u64,
}

/// The end: blocks of epochs, before each of which distances with larger errors gain weight
/// ([`super::equalise`]). The best block is what counts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Finish {
    /// Networks that take part.
    pub candidates: usize,
    /// Blocks; with 0 the best of the last stage is what counts.
    pub blocks: usize,
    /// Epochs of a block.
    pub epochs: u64,
    /// Histograms, drawn for the end.
    pub samples: u64,
    /// Histograms of each scene of the test grid that the best block is chosen by, drawn for that.
    pub choice: u64,
    /// Least ratio of an error to the mean that counts.
    pub least: f64,
    /// Largest ratio that counts.
    pub most: f64,
    /// Power of the ratio that multiplies a weight.
    pub power: f64,
    /// Power of a weight's own factor that is kept from the block before: with 1 weights gather all
    /// ratios, with less they settle at the ratio to the power of `power` / (1 - `keep`).
    pub keep: f64,
    /// Distances to either side whose errors count in a ratio, ever less with their number.
    pub neighbours: usize,
}

impl Default for Recipe {
    fn default() -> Self {
        let stage = |candidates, epochs, samples| Stage { candidates, epochs, samples };
        Recipe {
            neurons: NEURONS,
            checkpoint_epochs: 20,
            least_gain: 0.0,
            validation: 0,
            knots: None,
            inputs: InputScale::Deviation,
            table_noise: 0.4096,
            start: RandomStart { lengths: vec![0.1, 0.3], bias: 1.0, output_m: 0.1 },
            stages: vec![
                stage(120, 40, 8_000),
                stage(30, 60, 8_000),
                stage(8, 120, 24_000),
                stage(3, 400, 24_000),
            ],
            finish: Finish {
                candidates: 2,
                blocks: 14,
                epochs: 20,
                samples: 60_000,
                choice: 5,
                least: 0.7,
                most: 1.5,
                power: 0.75,
                keep: 0.85,
                neighbours: 1,
            },
            weighting: Weighting::default(),
            formats: Datapath::THESIS,
            limits: WordLimits::default(),
            optimiser: LmSettings { mu_min: 1e-12, ..LmSettings::default() },
        }
    }
}

impl Recipe {
    /// A training of seconds that shows that all works; its network is poor.
    pub fn quick() -> Self {
        let recipe = Recipe::default();
        Recipe {
            checkpoint_epochs: 3,
            stages: vec![
                Stage { candidates: 4, epochs: 6, samples: 603 },
                Stage { candidates: 2, epochs: 6, samples: 1005 },
            ],
            finish: Finish { blocks: 2, epochs: 5, samples: 2010, choice: 1, ..recipe.finish },
            ..recipe
        }
    }

    /// A stage by its place; after the last the end, of which it is one block.
    pub fn stage(&self, place: usize) -> Stage {
        let Finish { candidates, epochs, samples, .. } = self.finish;
        self.stages.get(place).copied().unwrap_or(Stage { candidates, epochs, samples })
    }
}
