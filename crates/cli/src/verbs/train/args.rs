//! The options of `tofsim train`.

use std::path::PathBuf;

use clap::{Args as _, Command, FromArgMatches};

use tofsim::error::Result;
use tofsim::scenario::builtin::Source;
use tofsim::scenario::{self, Loaded};
use tofsim_learn::training::recipe::Recipe;

use crate::choice::{seed, threads};
use crate::verbs::formats::Formats;

/// Train a depth network on simulated histograms, for the thesis's number formats or others
///
/// Options override grid, recipe, neurons and formats of the scenario's table [training].
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim train --profile uniform --seed 1 -o mine\n  \
    tofsim train --profile chain.toml -o mine       on your own chain\n  \
    tofsim train --resume -o mine                   resume an interrupted run\n  \
    tofsim train --with finish.blocks=10 -o mine    change a key of the recipe\n  \
    tofsim train --grid target.distance_m=0.05..0.9:0.0025 -o far   your own range\n  \
    tofsim train --data measured --profile chain.toml      your own histograms\n  \
    tofsim train --lut-bits 10 --format w1=12.19    other number formats\n  \
    tofsim run -s estimator.network=mine/network.toml")]
pub struct Args {
    /// Built-in scenario or scenario file: optics, detector and shots; its scene does not matter
    #[arg(default_value = scenario::DEFAULT)]
    pub(super) scenario: String,
    /// Set a scenario key, e.g. `spad.pdp=0.015`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
    /// Chain whose bins to train on, built-in or a file: tdc.profile of the scenario
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) profile: Option<String>,
    /// Seed of data and starts
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed())]
    pub(super) seed: u64,
    /// Scenes to train for: thesis, KEY=FROM..TO:STEP or KEY=A,B,C of any numeric key of the scenario (may be
    /// repeated; what none has is the scenario's), or a TOML file of those [default: thesis]
    #[arg(long, value_name = "GRID")]
    pub(super) grid: Vec<String>,
    /// Histograms of known distances instead of drawn ones: the folder of a dataset, a Parquet file with
    /// columns b0 to b255 and distance_m, or an .npy file with --truth
    #[arg(long, value_name = "PATH", conflicts_with = "grid")]
    pub(super) data: Option<PathBuf>,
    /// The true distances of --data [m]: an .npy file of n or n x k floats, distances first
    #[arg(long, value_name = "FILE", requires = "data")]
    pub(super) truth: Option<PathBuf>,
    /// Train for a few seconds only (poor accuracy)
    #[arg(long)]
    pub(super) quick: bool,
    /// Recipe: short (minutes), brief, quick (seconds), uniform-16, long, trainlm, or a TOML file; missing keys are
    /// those of the default recipe
    #[arg(long, value_name = "NAME|FILE")]
    pub(super) recipe: Option<PathBuf>,
    /// Set a key of the recipe, such as finish.blocks=10 or table_noise=0; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub(super) with: Vec<String>,
    /// Hidden neurons, 1 to 32 [default: 8, as in the thesis]
    #[arg(long, value_name = "N")]
    pub(super) neurons: Option<usize>,
    #[command(flatten)]
    pub(super) formats: Formats,
    /// Number of starts in the first stage
    #[arg(long, value_name = "N")]
    pub(super) starts: Option<usize>,
    /// Print the recipe as TOML and exit
    #[arg(long)]
    pub(super) print_recipe: bool,
    /// Continue from the checkpoint in the output folder
    #[arg(long)]
    pub(super) resume: bool,
    /// Stop after N checkpoints; continue with --resume
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) checkpoints: Option<u64>,
    /// Threads; the network is the same for any number [default: one a core]
    #[arg(long, value_name = "N", value_parser = threads())]
    pub(super) threads: Option<u16>,
    /// Write network.toml, accuracy.csv, curve.csv, curve.svg and checkpoint into this folder
    #[arg(short, long, value_name = "DIR", default_value = "training")]
    pub(super) output: PathBuf,
    /// Print one JSON object instead of a table
    #[arg(long)]
    pub(super) json: bool,
}

/// The word that stands for `--quick` in place of a recipe's path.
pub const QUICK: &str = "quick";

impl Args {
    /// Returns the options of an empty command line.
    pub(super) fn usual() -> Args {
        let command = Args::augment_args(Command::new("train"));
        let matches = command.get_matches_from(["train"]);
        Args::from_arg_matches(&matches).unwrap_or_else(|fault| fault.exit())
    }

    /// Fills in the scenario's own table where no option is given.
    ///
    /// # Errors
    /// When the table has a number format that is none.
    pub(super) fn over(&self, loaded: &Loaded) -> Result<Args> {
        let mut args = self.clone();
        let training = &loaded.scenario.training;
        if args.recipe.as_deref() == Some(QUICK.as_ref()) {
            (args.quick, args.recipe) = (true, None);
        }
        if let (Some(recipe), false, None) = (&training.recipe, args.quick, &args.recipe) {
            args.quick = recipe == QUICK;
            let path = match &loaded.files {
                Source::Folder(folder) if Recipe::builtin_text(recipe).is_none() => {
                    folder.join(recipe)
                }
                _ => PathBuf::from(recipe),
            };
            args.recipe = (!args.quick).then_some(path);
        }
        args.neurons = args.neurons.or(training.neurons.map(|neurons| neurons as usize));
        args.formats.put_under(&loaded.scenario.training, &loaded.name)?;
        Ok(args)
    }
}
