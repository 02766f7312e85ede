//! The recipe of a training: every number that decides what comes out, but for the seed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml_edit::{DocumentMut, Item};

use crate::quantize::datapath::Datapath;
use tofsim::error::{Input, Result};
use tofsim::files::toml::{Checked, assign, merge, read};
use tofsim::firmware::forward2::NEURONS;

use super::limits::Limits;
use super::lm::Settings;
use super::weighting::Weighting;

mod check;

/// How a network is trained.
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
    /// Noise of a neuron's sum from the activation table's steps [steps].
    pub table_noise: f64,
    /// Random starts.
    pub start: Start,
    /// The tournament: each stage goes on with the best of the one before.
    pub stages: Vec<Stage>,
    /// What is done with the winner.
    pub finish: Finish,
    /// Weights of the residuals.
    pub weighting: Weighting,
    /// Words that it is to fit, and the table of activations.
    pub formats: Datapath,
    /// Penalties for what the words cannot hold.
    pub limits: Limits,
    /// The optimiser.
    pub optimiser: Settings,
}

/// Random weights to begin with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Start {
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
    /// Blocks.
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
            table_noise: 0.4096,
            start: Start { lengths: vec![0.1, 0.3], bias: 1.0, output_m: 0.1 },
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
            formats: Datapath::default(),
            limits: Limits::default(),
            optimiser: Settings { mu_min: 1e-12, ..Settings::default() },
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

    /// The recipe in the text of a file; messages name `source`.
    ///
    /// # Errors
    /// When the text is no TOML, a key is unknown, or a value makes no sense.
    pub fn parse(text: &str, base: &Recipe, overrides: &[String], source: &str) -> Result<Self> {
        let mut table = base.table()?;
        merge(table.as_table_mut(), Checked::part::<Recipe>(source, text)?.table());
        for assignment in overrides {
            assign::<Recipe>(table.as_table_mut(), "--with", assignment)?;
        }
        let recipe: Recipe = read(source, table.as_table())?;
        recipe.check()?;
        Ok(recipe)
    }

    fn table(&self) -> Result<DocumentMut> {
        let table = toml_edit::ser::to_document(self);
        table.map_err(|error| Input::new("recipe", error).into())
    }

    /// All settings by dotted key, in TOML.
    pub fn settings(&self) -> Result<Vec<(String, String)>> {
        let mut settings = Vec::new();
        flatten("", self.table()?.as_item(), &mut settings);
        Ok(settings)
    }
}

fn flatten(path: &str, item: &Item, into: &mut Vec<(String, String)>) {
    match item.as_table_like() {
        Some(table) => table.iter().for_each(|(key, item)| {
            let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            flatten(&path, item, into);
        }),
        None => into.push((path.to_owned(), item.to_string().trim().to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn parse(text: &str, overrides: &[&str]) -> Result<Recipe> {
        let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
        Recipe::parse(text, &Recipe::default(), &overrides, "a.toml")
    }

    #[test]
    fn what_is_not_said_stays_and_an_option_comes_last() {
        let recipe = parse("table_noise = 0.0\n[finish]\nblocks = 3\n", &["finish.blocks=4"]);
        let recipe = recipe.unwrap();
        assert_eq!((recipe.table_noise, recipe.finish.blocks), (0.0, 4));
        assert_eq!(recipe.finish.epochs, Recipe::default().finish.epochs);
        assert_eq!(parse("", &[]).unwrap(), Recipe::default());
        Recipe::quick().check().unwrap();
    }

    #[test]
    fn settings_have_dotted_keys() {
        let settings = Recipe::default().settings().unwrap();
        assert!(settings.contains(&("finish.blocks".to_owned(), "14".to_owned())));
        assert!(settings.contains(&("optimiser.mu".to_owned(), "0.001".to_owned())));
    }
}
