//! Plans: the points of a sweep, and the quantities to compute at each.

pub mod axis;
pub mod builtin;
pub mod combination;
pub mod distribution;
mod fault;
pub mod file;
pub mod search;

use std::path::{Path, PathBuf};

use toml_edit::Table;

use tofsim::error::{Input, Result, hint, read_text};
use tofsim::files::toml::{Checked, assign};
use tofsim::scenario::{self, Loaded, Scenario};
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;
use tofsim_learn::estimation::EstimatorKind;

use crate::columns::{self, Column};
use axis::Axis;
use combination::{Combination, scenes};
use fault::at_key;
use file::{Fidelity, PlanFile, Plot, PlotKind};
use search::Search;

/// A checked plan.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Built-in name, or the file's stem.
    pub name: String,
    /// Text of the plan's file.
    pub text: String,
    /// Contents of the file, with defaults.
    pub file: PlanFile,
    /// Scenario, by built-in name or path.
    pub scenario: String,
    /// Overrides for all points: the plan's, followed by those of the command line.
    pub set: Vec<String>,
    /// Seed of the sweep.
    pub seed: u64,
    /// Estimators that evaluate each histogram.
    pub estimators: Vec<EstimatorKind>,
    /// Whether the points are images of an array.
    pub is_of_array: bool,
    /// Points.
    pub points: Combination,
    /// Scenes over which each point is averaged, as an assignment for each key.
    pub mean_over: Vec<Vec<String>>,
    /// Search at each point, if there is one.
    pub search: Option<Search>,
    /// Columns to compute, in the order of the table.
    pub outputs: Vec<Column>,
}

impl Plan {
    /// Loads a built-in plan by name or a plan file by path, with `key=value` overrides of the scenario and an
    /// optional seed.
    ///
    /// # Errors
    /// If there is no such plan, it is invalid, or the scenario has no such key or value.
    pub fn load(name: &str, set: &[String], seed: Option<u64>) -> Result<Self> {
        if let Some((name, text)) = builtin::plan(name) {
            return Plan::parse(name, &format!("plan {name}"), text, Path::new(""), set, seed);
        }
        let path = Path::new(name);
        if !path.exists() && !name.contains(['/', '.']) {
            let (hint, known) = hint(name, builtin::PLANS.iter().map(|(name, _)| *name));
            let expected =
                format!("no such file or built-in plan{hint}; expected a path or one of {known}");
            return Err(Input::new("plan", expected).value(name).into());
        }
        let text = read_text(path)?;
        let stem = path.file_stem().map_or(name.into(), |stem| stem.to_string_lossy());
        Plan::parse(&stem, name, &text, path.parent().unwrap_or(Path::new("")), set, seed)
    }

    /// Parses the text of a plan file. Errors name it as `source`; paths in it are relative to `folder`.
    ///
    /// # Errors
    /// If it is invalid, or the scenario has no such key or value.
    pub fn parse(
        name: &str,
        source: &str,
        text: &str,
        folder: &Path,
        overrides: &[String],
        seed: Option<u64>,
    ) -> Result<Self> {
        let checked = Checked::parse::<PlanFile>(source, text)?;
        let file: PlanFile = checked.read()?;
        let scenario = from_folder(&file.scenario, folder);
        Plan::checked(name, text, (checked, file, scenario), overrides, seed)
    }

    /// Parses the text of a plan file, but uses another scenario, by built-in name or path relative to `folder`.
    ///
    /// # Errors
    /// If it is invalid, or the scenario has no such key or value.
    pub fn parse_for(
        name: &str,
        source: &str,
        text: &str,
        (scenario, folder): (&str, &Path),
        overrides: &[String],
        seed: Option<u64>,
    ) -> Result<Self> {
        let checked = Checked::parse::<PlanFile>(source, text)?;
        let file: PlanFile = checked.read()?;
        let scenario = from_folder(scenario, folder);
        Plan::checked(name, text, (checked, file, scenario), overrides, seed)
    }

    fn checked(
        name: &str,
        text: &str,
        (checked, file, scenario): (Checked, PlanFile, String),
        overrides: &[String],
        seed: Option<u64>,
    ) -> Result<Self> {
        let set: Vec<_> = file.set.iter().chain(overrides).cloned().collect();
        for (place, assignment) in file.set.iter().enumerate() {
            let fault = |error| at_key(&checked, &format!("set.{place}"), error);
            assign::<Scenario>(&mut Table::new(), "set", assignment).map_err(fault)?;
        }
        let loaded = scenario::load(&scenario, &set)?;
        let seed = seed.or(file.seed).unwrap_or(loaded.scenario.seed);
        let axes = Axis::all(&checked, "axis", &file.axis)?;
        check_overrides(&file, overrides)?;
        let mean_over = Axis::all(&checked, "mean_over", &file.mean_over)?;
        let taken: Vec<_> = axes.iter().map(|axis| axis.key.as_str()).collect();
        let mean_over = scenes(&checked, "mean_over", &mean_over, &taken)?;
        let points = Combination::new(&checked, &file, axes, seed)?;
        let estimators = estimators(&checked, &file, &loaded)?;
        let is_of_array = loaded.scenario.array.count() > 1;
        let known = if is_of_array {
            check_array(&checked, &file)?;
            columns::of_images()
        } else {
            columns::all(file.fidelity, &estimators)
        };
        let outputs = columns::chosen(&checked, &file.outputs, &known)?;
        let search = file.search.as_ref();
        let search = search.map(|search| Search::new(&checked, search, &points, &known));
        let search = search.transpose()?;
        let text = text.to_owned();
        let plan = Plan {
            name: name.to_owned(),
            text,
            file,
            scenario,
            set,
            seed,
            estimators,
            is_of_array,
            points,
            mean_over,
            search,
            outputs,
        };
        plan.file.plot.iter().try_for_each(|plot| plan.check_plot(&checked, plot))?;
        Ok(plan)
    }

    /// Loads the scenario with the overrides for all points.
    ///
    /// # Errors
    /// If it is no longer valid.
    pub fn base(&self) -> Result<Loaded> {
        self.loaded(&[])
    }

    /// Loads the scenario of a point.
    ///
    /// # Errors
    /// If its settings are inconsistent.
    pub fn loaded(&self, settings: &[String]) -> Result<Loaded> {
        let set: Vec<_> = self.set.iter().chain(settings).cloned().collect();
        let mut loaded = scenario::load(&self.scenario, &set)?;
        loaded.scenario.seed = self.seed;
        Ok(loaded)
    }

    /// Returns the setup of the scenario with the overrides for all points; of an array, what its pixels have in common.
    ///
    /// # Errors
    /// If it cannot be elaborated.
    pub fn setup(&self) -> Result<Setup> {
        let loaded = self.base()?;
        if self.is_of_array {
            return Ok(ArraySetup::new(loaded)?.common().clone());
        }
        Setup::of_counts(loaded)
    }

    /// Returns the names of the columns that a plot can use.
    fn shown(&self) -> Vec<String> {
        let axes = self.points.axes.iter().map(|axis| axis.key.clone());
        let found = self.search.iter().map(|search| search.key.clone());
        ["point".to_owned()]
            .into_iter()
            .chain(axes)
            .chain(found)
            .chain(self.outputs.iter().map(|column| column.name.clone()))
            .collect()
    }

    fn check_plot(&self, checked: &Checked, plot: &Plot) -> Result<()> {
        let shown = self.shown();
        if plot.y.is_empty() || (plot.kind == PlotKind::Surface && plot.y.len() != 2) {
            let expected =
                "expected a column at least, and two of a surface: one up, one as its colour";
            return Err(checked.fault("plot.y", expected).into());
        }
        let series = plot.series.iter().enumerate();
        let series = series.map(|(k, name)| (format!("plot.series.{k}"), name));
        let y = plot.y.iter().enumerate().map(|(k, name)| (format!("plot.y.{k}"), name));
        for (key, name) in [("plot.x".to_owned(), &plot.x)].into_iter().chain(series).chain(y) {
            if !shown.contains(name) {
                let (hint, known) = hint(name, shown.iter().map(String::as_str));
                let expected = format!("no such column{hint}; expected one of {known}");
                return Err(checked.fault(&key, expected).into());
            }
        }
        Ok(())
    }
}

/// Checks that the overrides do not set a key that the plan varies.
fn check_overrides(file: &PlanFile, overrides: &[String]) -> Result<()> {
    let searched = file.search.iter().flat_map(|search| {
        [&search.key].into_iter().chain(search.over.iter().map(|axis| &axis.key))
    });
    let axes = file.axis.iter().chain(&file.mean_over).map(|axis| &axis.key);
    let varied: Vec<_> = axes.chain(searched).collect();
    for assignment in overrides {
        let key = assignment.split('=').next().unwrap_or_default().trim();
        if varied.iter().any(|varied| *varied == key) {
            let expected = "the plan has the values of this key";
            return Err(Input::new(format!("-s {assignment}"), expected).into());
        }
    }
    Ok(())
}

/// Checks that the plan asks for what images have.
fn check_array(checked: &Checked, file: &PlanFile) -> Result<()> {
    if file.fidelity == Fidelity::Budget {
        let expected = "expected histogram, shot or cycle with an array of pixels";
        return Err(checked.fault("fidelity", expected).into());
    }
    if !file.estimators.is_empty() {
        let expected =
            "expected none with an array of pixels: images are of its firmware's estimator";
        return Err(checked.fault("estimators", expected).into());
    }
    Ok(())
}

/// Resolves a path relative to the plan's folder; a name is returned unchanged.
fn from_folder(name: &str, folder: &Path) -> String {
    let is_path = name.contains(['/', '.']) && Path::new(name).is_relative();
    let path = if is_path { folder.join(name) } else { PathBuf::from(name) };
    path.display().to_string()
}

fn estimators(checked: &Checked, file: &PlanFile, loaded: &Loaded) -> Result<Vec<EstimatorKind>> {
    let kind = |(place, given): (usize, &String)| {
        EstimatorKind::find(given).ok_or_else(|| {
            let (hint, known) = hint(given, EstimatorKind::names());
            let expected = format!("no such estimator{hint}; expected one of {known}");
            checked.fault(&format!("estimators.{place}"), expected).into()
        })
    };
    let kinds: Result<Vec<_>> = file.estimators.iter().enumerate().map(kind).collect();
    Ok(match kinds? {
        none if none.is_empty() => vec![EstimatorKind::in_socket(&loaded.scenario)],
        kinds => kinds,
    })
}

#[cfg(test)]
mod tests;
