//! All that decides how a training goes on.

use serde::{Deserialize, Serialize};

use tofsim::files::digest::digest;

use super::data::Samples;
use super::features::Scaling;
use super::lm::Lm;
use super::recipe::Recipe;
use super::start::start;

/// A network that takes part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Candidate {
    /// Number of the start that it comes from.
    pub start: usize,
    /// Epochs made since the last checkpoint of the recipe.
    #[serde(default, skip_serializing_if = "is_none")]
    pub made: u64,
    /// State of its training.
    pub lm: Lm,
    /// Factor on the weights at each distance, once the end has begun [1].
    pub factors: Vec<f64>,
}

fn is_none(count: &u64) -> bool {
    *count == 0
}

/// The best block so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BestBlock {
    /// Number of the start that it comes from.
    pub start: usize,
    /// Blocks made by then.
    pub block: usize,
    /// Largest ratio of a spread to the line, in fixed point.
    pub ratio: f64,
    /// Whether weights had to be saturated for that.
    #[serde(default)]
    pub saturated: bool,
    /// Parameters.
    pub x: Vec<f64>,
}

/// A point of the learning curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurvePoint {
    /// Stage, counted from 0; the end is the last.
    pub stage: usize,
    /// Block of the end, counted from 0.
    pub block: usize,
    /// Start that the network comes from.
    pub start: usize,
    /// Epochs that it has been trained.
    pub epochs: u64,
    /// Its cost.
    pub cost: f64,
    /// Its damping.
    pub mu: f64,
    /// Its mean square on the data of the validation stop, if there are any.
    pub validation: Option<f64>,
    /// At the end of a block, its largest ratio of a spread to the line or of a mean error to its
    /// limit, in fixed point; infinite if it does not fit the words.
    pub ratio: Option<f64>,
}

/// All that decides how a tournament goes on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TournamentState {
    /// Stage that is going on; the end is the last.
    pub stage: usize,
    /// Block of the end that is going on.
    pub block: usize,
    /// Epochs made of this stage or block.
    pub epochs: u64,
    /// Digest of all data used so far, in hexadecimal.
    pub data: String,
    /// Scaling of inputs.
    pub scaling: Scaling,
    /// Candidates still taking part.
    pub candidates: Vec<Candidate>,
    /// The best block.
    pub best: Option<BestBlock>,
    /// Course of the costs.
    pub curve: Vec<CurvePoint>,
}

impl TournamentState {
    /// At the beginning.
    pub(super) fn new(recipe: &Recipe, seed: u64, scaling: Scaling) -> Self {
        let size = [recipe.neurons, scaling.columns()];
        let candidate = |number| Candidate {
            start: number,
            made: 0,
            lm: Lm::new(start(&recipe.start, size, seed, number), &recipe.optimiser),
            factors: Vec::new(),
        };
        let candidates = (0..recipe.stages[0].candidates).map(candidate).collect();
        TournamentState { scaling, candidates, ..TournamentState::default() }
    }

    /// Adds samples to the digest of the data.
    pub(super) fn saw(&mut self, samples: &Samples) {
        let own = samples.digest();
        let first = self.data.is_empty();
        let both = if first { own } else { digest(own, self.data.as_bytes()) };
        self.data = format!("{both:016x}");
    }
}
