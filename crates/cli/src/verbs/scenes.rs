//! The scenes of verbs that draw histograms over a grid.

use tofsim::Note;
use tofsim::error::{Error, Input, Result};
use tofsim::scenario::Loaded;
use tofsim::sim::setup::Setup;
use tofsim_learn::dataset::{Grid, GridOption, GridPurpose, HistogramSource};

/// A grid, and what its histograms are drawn from.
pub struct Scenes {
    /// Grid options of the command line.
    pub option: GridOption,
    /// The grid.
    pub grid: Grid,
    /// The scenario of each setting of the grid's other keys, with the overrides of the command line.
    pub loaded: Vec<Loaded>,
    /// Scenarios that are ready to run.
    pub setups: Vec<Setup>,
    /// Draws the histograms.
    pub source: HistogramSource,
}

impl Scenes {
    /// Reads the options `--grid` and `-s`, or the scenario's own grid for its training; `load` makes the scenario
    /// with keys set.
    ///
    /// # Errors
    /// When an option is wrong, an override says what the grid says, or there is no closed form.
    pub fn new(
        options: &[String],
        set: &[String],
        purpose: GridPurpose,
        load: impl Fn(&[String]) -> Result<Loaded>,
    ) -> Result<Self> {
        let base = load(set)?;
        if !options.is_empty() {
            return Self::of_options(options, set, purpose, base, load);
        }
        let (own, name) = (base.scenario.training.grid_options(), base.name.clone());
        let scenes = Self::of_options(&own, set, purpose, base, load);
        scenes.map_err(|error| of_the_own_grid(error, &name))
    }

    fn of_options(
        options: &[String],
        set: &[String],
        purpose: GridPurpose,
        base: Loaded,
        load: impl Fn(&[String]) -> Result<Loaded>,
    ) -> Result<Self> {
        let option = GridOption::parse(options)?;
        option.check_overrides(set)?;
        let grid = option.grid(&base.scenario, purpose)?;
        let of_setting = |setting| {
            let keys = grid.setting(setting).into_iter();
            let keys = keys.map(|(key, value)| format!("{key}={value}"));
            let loaded = load(&set.iter().cloned().chain(keys).collect::<Vec<_>>());
            Ok(Loaded { set: set.to_vec(), ..loaded.map_err(of_the_grid)? })
        };
        let loaded = if grid.others.is_empty() {
            vec![base]
        } else {
            (0..grid.settings() as usize).map(of_setting).collect::<Result<_>>()?
        };
        let setups = loaded.iter().cloned().map(Setup::of_counts).collect::<Result<Vec<_>>>()?;
        let source = HistogramSource::of_settings(&setups)?;
        Ok(Scenes { option, grid, loaded, setups, source })
    }

    /// The grid for another purpose.
    ///
    /// # Errors
    /// When it is too large.
    pub fn grid_for(&self, purpose: GridPurpose) -> Result<Grid> {
        self.option.grid(&self.loaded[0].scenario, purpose)
    }

    /// Returns the notes on scenes without a depth: an echo past the last bin, or none, where the target
    /// is farthest and darkest. Each cause once.
    ///
    /// # Errors
    /// When a scenario has no such scene.
    pub fn notes(&self) -> Result<Vec<Note>> {
        let mut notes: Vec<Note> = Vec::new();
        for loaded in &self.loaded {
            let mut loaded = loaded.clone();
            loaded.scenario.target.distance_m = self.grid.distances_m.range()[1];
            loaded.scenario.target.reflectance = self.grid.reflectances.range()[0];
            let setup = Setup::of_counts(loaded)?;
            if setup.true_depth_m().is_some() {
                continue;
            }
            for note in setup.notes()? {
                if notes.iter().all(|known| known.key != note.key) {
                    notes.push(note);
                }
            }
        }
        Ok(notes)
    }
}

/// Names the scenario's own file in an error of its grid.
pub fn of_the_own_grid(error: Error, scenario: &str) -> Error {
    match error {
        Error::Input(input) => match input.source.strip_prefix("--grid") {
            Some(key) => {
                let source = format!("scenario {scenario}: training.grid{key}");
                Input { source, ..*input }.into()
            }
            None => Error::Input(input),
        },
        other => other,
    }
}

/// Names the grid's key in an error.
fn of_the_grid(error: Error) -> Error {
    match error {
        Error::Input(input) => match input.source.strip_prefix("-s ") {
            Some(key) => Input { source: format!("--grid {key}"), ..*input }.into(),
            None => Error::Input(input),
        },
        other => other,
    }
}
