//! The scenes of verbs that draw histograms over a grid.

use tofsim::error::{Error, Input, Result};
use tofsim::scenario::Loaded;
use tofsim::sim::setup::Setup;
use tofsim_learn::dataset::{Grid, GridOption, GridPurpose, HistogramSource};

/// A grid, and what its histograms are drawn from.
pub struct Scenes {
    /// The grid.
    pub grid: Grid,
    /// The scenario of each setting of the grid's other keys, with the overrides of the command line.
    pub loaded: Vec<Loaded>,
    /// The same, ready to run.
    pub setups: Vec<Setup>,
    /// Draws the histograms.
    pub source: HistogramSource,
}

impl Scenes {
    /// From the options `--grid` and `-s`; `load` makes the scenario with keys set.
    ///
    /// # Errors
    /// When an option is wrong, an override says what the grid says, or there is no closed form.
    pub fn new(
        options: &[String],
        set: &[String],
        purpose: GridPurpose,
        load: impl Fn(&[String]) -> Result<Loaded>,
    ) -> Result<Self> {
        let option = GridOption::parse(options)?;
        option.check_overrides(set)?;
        let base = load(set)?;
        let grid = option.grid(&base.scenario, purpose)?;
        let of_setting = |setting| {
            let keys = grid.setting(setting).into_iter();
            let keys = keys.map(|(key, value)| format!("{key}={value}"));
            let loaded = load(&set.iter().cloned().chain(keys).collect::<Vec<_>>());
            Ok(Loaded { set: set.to_vec(), ..loaded.map_err(of_the_grid)? })
        };
        let loaded = match grid.others.is_empty() {
            true => vec![base],
            false => (0..grid.settings() as usize).map(of_setting).collect::<Result<_>>()?,
        };
        let setups = loaded.iter().cloned().map(Setup::new).collect::<Result<Vec<_>>>()?;
        let source = HistogramSource::of_settings(&setups)?;
        Ok(Scenes { grid, loaded, setups, source })
    }
}

/// What a key of the grid is refused for.
fn of_the_grid(error: Error) -> Error {
    match error {
        Error::Input(input) => match input.source.strip_prefix("-s ") {
            Some(key) => Input { source: format!("--grid {key}"), ..*input }.into(),
            None => Error::Input(input),
        },
        other => other,
    }
}
