//! Training data of a network: scenes on a grid, or your own histograms.

use tofsim::Note;
use tofsim::error::{Input, Result};
use tofsim::scenario::{self, Loaded, Scenario};
use tofsim::sim::setup::Setup;
use tofsim_learn::dataset::{GridOption, GridPurpose, Labelled};
use tofsim_learn::training::data::{PulseTimes, TrainingMaterial, TrainingScenes, fingerprint};
use tofsim_learn::training::measured::MeasuredParts;
use tofsim_learn::training::weighting::Weighting;

use crate::verbs::draws::from_here;
use crate::verbs::pixel::common_of_counts;
use crate::verbs::scenes::Scenes;

use super::args::Args;

/// Sources of the histograms.
pub enum Origin {
    /// Histograms that are drawn over a grid.
    Grid(Box<Scenes>),
    /// Histograms in files.
    Measured {
        /// Dealt out.
        parts: Box<MeasuredParts>,
        /// Least and largest value of what is known of them.
        ranges: Vec<(&'static str, [f64; 2])>,
        /// The scenario that they are of.
        loaded: Box<Loaded>,
    },
}

impl Origin {
    /// Reads the options.
    ///
    /// # Errors
    /// When an option is wrong or a file is no data.
    pub fn new(args: &Args) -> Result<Self> {
        let load = |set: &[String]| {
            let mut loaded = scenario::load(&args.scenario, set)?;
            if let Some(profile) = &args.profile {
                loaded.scenario.tdc.profile = from_here(profile, &loaded)?;
            }
            Ok(loaded)
        };
        if let Some(data) = &args.data {
            let loaded = load(&args.set)?;
            let labelled =
                Labelled::read(data, args.truth.as_deref(), &loaded.scenario.histogram())?;
            labelled.check(data, &loaded.scenario)?;
            let setup = common_of_counts(loaded.clone())?;
            let pulse = PulseTimes {
                delay_ps: setup.scenario.laser.delay_ps,
                sigma_ps: setup.budget.pulse.sigma_ps(),
            };
            let parts = MeasuredParts::new(&labelled, setup.bins(), pulse, args.seed)?;
            return Ok(Origin::Measured {
                parts: Box::new(parts),
                ranges: labelled.ranges(),
                loaded: Box::new(loaded),
            });
        }
        let scenes = Scenes::new(&args.grid, &args.set, GridPurpose::Training, load)?;
        scenes.check_single("training over a grid")?;
        if matches!(scenes.option, GridOption::ThesisOf(_)) {
            let expected =
                "expected thesis, which has a grid for training and one for tests, or KEY=...";
            return Err(Input::new("--grid", expected).value(args.grid.join(" ")).into());
        }
        Ok(Origin::Grid(Box::new(scenes)))
    }

    /// Returns the histograms to train, choose and test on.
    ///
    /// # Errors
    /// When the grid is too large.
    pub fn material(&self) -> Result<Box<dyn TrainingMaterial + '_>> {
        Ok(match self {
            Origin::Grid(scenes) => Box::new(drawn(scenes)?),
            Origin::Measured { parts, .. } => parts.clone(),
        })
    }

    /// The weighting that is not the thesis's.
    ///
    /// # Errors
    /// When a scene of the grid tells nothing of its distance.
    pub fn weighting(&self) -> Result<Option<Weighting>> {
        Ok(match self {
            Origin::Grid(scenes) if scenes.grid.is_thesis() => None,
            Origin::Grid(scenes) => {
                let drawn = drawn(scenes)?;
                Some(Weighting::of_scenes(&scenes.source, &drawn.training, &drawn.test)?)
            }
            Origin::Measured { parts, .. } => Some(Weighting::flat(parts.distances_m())),
        })
    }

    /// Returns the notes on scenes without a depth.
    ///
    /// # Errors
    /// When a scenario has no such scene.
    pub fn notes(&self) -> Result<Vec<Note>> {
        match self {
            Origin::Grid(scenes) => scenes.notes(),
            Origin::Measured { .. } => Ok(Vec::new()),
        }
    }

    /// Returns the settings that a checkpoint belongs to, beside recipe and seed.
    pub fn settings(&self) -> Vec<(String, String)> {
        let one = |key: &str, value: String| (key.to_owned(), value);
        match self {
            Origin::Grid(scenes) => {
                let mut settings = vec![one("scenario", fingerprint(&scenes.source))];
                if !scenes.grid.is_thesis() {
                    let axes: Vec<_> = scenes.grid.axes().map(ToString::to_string).collect();
                    settings.push(one("grid", axes.join(" ")));
                }
                settings
            }
            Origin::Measured { parts, .. } => vec![one("data", format!("{:016x}", parts.digest()))],
        }
    }

    /// The scenario, of the first setting.
    pub fn scenario(&self) -> &Scenario {
        match self {
            Origin::Grid(scenes) => &scenes.loaded[0].scenario,
            Origin::Measured { loaded, .. } => &loaded.scenario,
        }
    }

    /// Returns the scenario, ready to run.
    ///
    /// # Errors
    /// When a file that it names cannot be used.
    pub fn setup(&self) -> Result<Setup> {
        match self {
            Origin::Grid(scenes) => Ok(scenes.setups[0].clone()),
            Origin::Measured { loaded, .. } => common_of_counts((**loaded).clone()),
        }
    }

    /// Least and largest value of the keys that vary.
    pub fn ranges(&self) -> Vec<(&str, [f64; 2])> {
        match self {
            Origin::Grid(scenes) => scenes.grid.ranges(),
            Origin::Measured { ranges, .. } => ranges.clone(),
        }
    }
}

fn drawn(scenes: &Scenes) -> Result<TrainingScenes<'_>> {
    let test = scenes.grid_for(GridPurpose::Test)?;
    Ok(TrainingScenes::of_grids(&scenes.source, scenes.grid.clone(), test))
}
