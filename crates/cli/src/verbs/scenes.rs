//! The scenes of verbs that draw histograms over a grid.

use std::sync::Arc;

use tofsim::Note;
use tofsim::error::{Error, Input, Result};
use tofsim::note::NoteCode;
use tofsim::scenario::Loaded;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;
use tofsim_learn::dataset::{Grid, GridArray, GridOption, GridPurpose, HistogramSource};

/// Most pixels of the arrays of all settings, whose light is held in memory: 1.5 GB of the scenario `array`.
const MOST_PIXELS: u64 = 1 << 16;

/// A grid, and what its histograms are drawn from.
pub struct Scenes {
    /// Grid options of the command line.
    pub option: GridOption,
    /// The grid.
    pub grid: Grid,
    /// The scenario of each setting of the grid's other keys, with the overrides of the command line.
    pub loaded: Vec<Loaded>,
    /// Scenarios that are ready to run; of an array, what its pixels have in common.
    pub setups: Vec<Setup>,
    /// The arrays of those scenarios, if they have several pixels.
    pub arrays: Vec<Arc<ArraySetup>>,
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
        let option = GridOption::parse_for(options, &base.scenario)?;
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
        if grid.array.is_some() {
            return Self::of_arrays(option, grid, loaded);
        }
        let setups = loaded.iter().cloned().map(Setup::of_counts).collect::<Result<Vec<_>>>()?;
        let source = HistogramSource::of_settings(&setups)?;
        Ok(Scenes { option, grid, loaded, setups, arrays: Vec::new(), source })
    }

    fn of_arrays(option: GridOption, grid: Grid, loaded: Vec<Loaded>) -> Result<Self> {
        check_pixels(&grid)?;
        let array = |loaded| Ok(Arc::new(ArraySetup::of_counts(loaded)?));
        let arrays = loaded.iter().cloned().map(array).collect::<Result<Vec<_>>>()?;
        let source = HistogramSource::of_arrays(&arrays)?;
        let setups = arrays.iter().map(|array| array.common().clone()).collect();
        let with_depths = |pixels: GridArray| pixels.with_depths(arrays.iter().map(|one| &**one));
        let grid = Grid { array: grid.array.map(with_depths), ..grid };
        Ok(Scenes { option, grid, loaded, setups, arrays, source })
    }

    /// Refuses an array for `user`, which is for single pixels.
    ///
    /// # Errors
    /// When the scenario has several pixels.
    pub fn check_single(&self, user: &str) -> Result<()> {
        let Some(array) = &self.grid.array else { return Ok(()) };
        let (key, count) = match array.rows {
            1 => ("array.columns", array.columns),
            rows => ("array.rows", rows),
        };
        let expected = format!("expected 1: {user} takes single pixels only");
        let fault = Input::new(format!("scenario {}", self.loaded[0].name), expected);
        Err(fault.field(key).value(count).into())
    }

    /// The grid for another purpose.
    ///
    /// # Errors
    /// When it is too large.
    pub fn grid_for(&self, purpose: GridPurpose) -> Result<Grid> {
        let grid = self.option.grid(&self.loaded[0].scenario, purpose)?;
        Ok(Grid { array: self.grid.array.clone(), ..grid })
    }

    /// Returns the notes on scenes without a depth: an echo past the last bin, or none, where the target
    /// is farthest and darkest. Each cause once, and of an array with the number of pixels that have it.
    ///
    /// # Errors
    /// When a scenario has no such scene.
    pub fn notes(&self) -> Result<Vec<Note>> {
        let mut notes: Vec<Note> = Vec::new();
        for loaded in &self.loaded {
            let mut loaded = loaded.clone();
            loaded.scenario.target.reflectance = self.grid.reflectances.range()[0];
            for note in self.notes_of(loaded)? {
                if notes.iter().all(|known| known.key != note.key) {
                    notes.push(note);
                }
            }
        }
        Ok(notes)
    }

    /// Returns the notes on a setting with the least reflectance: at the largest distance, or of all pixels, whatever
    /// estimator they have.
    fn notes_of(&self, mut loaded: Loaded) -> Result<Vec<Note>> {
        if self.grid.array.is_some() {
            let mut notes = ArraySetup::of_counts(loaded)?.notes()?;
            notes.retain(|note| note.code != NoteCode::OutsideTraining);
            return Ok(notes);
        }
        loaded.scenario.target.distance_m = self.grid.distances_m.range()[1];
        let setup = Setup::of_counts(loaded)?;
        if setup.true_depth_m().is_some() { Ok(Vec::new()) } else { setup.notes() }
    }
}

/// Checks that the pixels of all settings are not too many.
fn check_pixels(grid: &Grid) -> Result<()> {
    let pixels = grid.array.as_ref().map_or(1, |array| array.count() as u64);
    let count = grid.settings().saturating_mul(pixels);
    if count <= MOST_PIXELS {
        return Ok(());
    }
    let expected = format!(
        "{count} pixels in {} settings of the keys that change the scene, expected {MOST_PIXELS} in all at most: \
         reflectance and irradiance cost none",
        grid.settings()
    );
    Err(Input::new("--grid", expected).into())
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
