//! A scenario, which travels as text.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString, PyTuple};
use serde_json::json;
use tempfile::TempDir;

use tofsim::error::{Error, read_text};
use tofsim::scenario::builtin::{self, Source};
use tofsim::scenario::bundle::Bundle;
use tofsim::scenario::{DEFAULT, Loaded, from_text, load, show};
use tofsim::{Network as Trained, Setup};

use crate::errors::Result;
use crate::network::Network;
use crate::objects::{assignments, object};
use crate::pictures;

/// One experiment: target, light, sensor, firmware and what is recorded of it.
///
/// From a built-in name, the path or the text of a TOML file, or a dictionary of tables.
#[pyclass(module = "tofsim", frozen, skip_from_py_object)]
#[derive(Clone)]
pub struct Scenario {
    /// Name of the source in errors.
    source: String,
    text: String,
    pub(crate) loaded: Loaded,
    /// Keeps the files that it came with.
    _home: Option<Arc<TempDir>>,
}

/// Files by name, as they travel.
type Files = BTreeMap<String, Vec<u8>>;

impl Scenario {
    /// From its text.
    fn parsed(name: &str, source: &str, text: &str, files: Source, set: &[String]) -> Result<Self> {
        let loaded = from_text(name, source, text, files, set)?;
        Ok(Scenario { source: source.to_owned(), text: text.to_owned(), loaded, _home: None })
    }

    /// By name or path.
    pub fn load(name: &str, set: &[String]) -> Result<Self> {
        let loaded = load(name, set)?;
        let (source, text) = match builtin::scenario(name) {
            Some(text) => (format!("scenario {name}"), text.to_owned()),
            None => (name.to_owned(), read_text(Path::new(name))?),
        };
        Ok(Scenario { source, text, loaded, _home: None })
    }

    /// Converts a function's argument: a scenario, or an argument of its constructor; the default if there is none.
    pub fn of(given: Option<&Bound<'_, PyAny>>) -> Result<Self> {
        match given.map(|given| given.cast::<Scenario>()) {
            Some(Ok(scenario)) => Ok(scenario.get().clone()),
            _ => Scenario::new(given, None),
        }
    }

    /// The scenario with a seed of its own, if one is given.
    pub fn seeded(&self, seed: Option<u64>) -> Loaded {
        let mut loaded = self.loaded.clone();
        loaded.scenario.seed = seed.unwrap_or(loaded.scenario.seed);
        loaded
    }

    /// How a command line names it where it is: a built-in name, or a path.
    pub fn word(&self) -> String {
        let name = &self.loaded.name;
        match builtin::scenario(name) == Some(&self.text) {
            true => name.clone(),
            false if self.source.ends_with(".toml") => self.source.clone(),
            false => format!("{name}.toml"),
        }
    }

    /// The same with other overrides.
    ///
    /// # Errors
    /// When one is none.
    pub fn with_set(&self, set: &[String]) -> tofsim::Result<Loaded> {
        let Loaded { name, files, .. } = &self.loaded;
        from_text(name, &self.source, &self.text, files.clone(), set)
    }

    /// With the files that it names and others in a folder of its own.
    fn with_files(&self, more: Files, set: Vec<String>) -> Result<Self> {
        let mut bundle = Bundle::of(&self.loaded.files, &self.loaded.scenario)?;
        bundle.files.extend(more);
        let set = [self.loaded.set.clone(), bundle.set, set].concat();
        Self::_travelled(&self.loaded.name, &self.source, &self.text, set, Some(bundle.files))
    }

    fn setup(&self) -> Result<Setup> {
        Ok(Setup::of_counts(self.loaded.clone())?)
    }
}

#[pymethods]
impl Scenario {
    #[new]
    #[pyo3(signature = (source = None, *, folder = None))]
    fn new(source: Option<&Bound<'_, PyAny>>, folder: Option<PathBuf>) -> Result<Self> {
        let Some(source) = source else { return Scenario::load(DEFAULT, &[]) };
        if let Ok(tables) = source.cast::<PyDict>() {
            let files = folder.map_or(Source::BuiltIn, Source::Folder);
            return Scenario::parsed("scenario", "scenario", "", files, &assignments(tables)?);
        }
        if let Ok(text) = source.cast::<PyString>() {
            let text = text.to_str()?;
            if text.contains(['\n', '=']) && !Path::new(text).exists() {
                let files = folder.map_or(Source::BuiltIn, Source::Folder);
                return Scenario::parsed("scenario", "scenario", text, files, &[]);
            }
        }
        let path: PathBuf = source.extract()?;
        Scenario::load(&path.display().to_string(), &[])
    }

    /// The same with other values: tables as keywords, or a dictionary of dotted keys.
    #[pyo3(signature = (keys = None, /, **tables))]
    fn with_(
        &self,
        keys: Option<&Bound<'_, PyDict>>,
        tables: Option<&Bound<'_, PyDict>>,
    ) -> Result<Self> {
        let mut set = self.loaded.set.clone();
        for given in [keys, tables].into_iter().flatten() {
            set.extend(assignments(given)?);
        }
        let Loaded { name, files, .. } = &self.loaded;
        let other = Scenario::parsed(name, &self.source, &self.text, files.clone(), &set)?;
        Ok(Scenario { _home: self._home.clone(), ..other })
    }

    /// The same with another network in its estimator.
    fn with_network(&self, network: &Bound<'_, Network>) -> Result<Self> {
        const FILE: &str = "network.toml";
        let text = network.get().network.to_toml().into_bytes();
        let set = vec![format!("estimator.network={FILE}")];
        self.with_files([(FILE.to_owned(), text)].into(), set)
    }

    /// Built-in name, or the file's stem.
    #[getter]
    fn name(&self) -> &str {
        &self.loaded.name
    }

    /// What it shows.
    #[getter]
    fn description(&self) -> &str {
        &self.loaded.scenario.description
    }

    /// Seed of every random stream.
    #[getter]
    fn seed(&self) -> u64 {
        self.loaded.scenario.seed
    }

    /// The overrides in it, as `key=value`.
    #[getter]
    fn set(&self) -> Vec<String> {
        self.loaded.set.clone()
    }

    /// A number that changes with any key and with what is in the files that it names.
    #[getter]
    fn hash(&self) -> Result<String> {
        Ok(self.setup()?.hash())
    }

    /// Distance of the target, if light of it can be seen [m].
    #[getter]
    fn true_depth_m(&self) -> Result<Option<f64>> {
        Ok(self.setup()?.true_depth_m())
    }

    /// Distance of the second target, if the firmware looks for one and light of it can be seen [m].
    #[getter]
    fn second_true_depth_m(&self) -> Result<Option<f64>> {
        Ok(self.setup()?.true_depths().and_then(|truth| truth.second_m))
    }

    /// What its results lie outside of.
    fn notes<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(object(py, &json!(self.setup()?.notes()?))?)
    }

    /// Every value.
    fn to_dict<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(object(py, &json!(self.loaded.scenario))?)
    }

    /// Every key with its meaning, unit, range and source, as TOML.
    fn to_toml(&self) -> String {
        show::show(&self.loaded.scenario)
    }

    /// The value at a dotted key.
    fn __getitem__<'py>(&self, py: Python<'py>, key: &str) -> Result<Bound<'py, PyAny>> {
        let values = json!(self.loaded.scenario);
        let found = key.split('.').try_fold(&values, |table, part| table.get(part));
        let missing = || pyo3::exceptions::PyKeyError::new_err(key.to_owned());
        Ok(object(py, found.ok_or_else(missing)?)?)
    }

    /// How a command line names it: a scenario's name or path, and overrides. What was a text is written to a file, in
    /// `home` if it came from no folder.
    fn _words(&self, home: PathBuf) -> Result<(String, Vec<String>)> {
        let set: Vec<_> = self.loaded.set.iter().map(|set| format!("--set={set}")).collect();
        if builtin::scenario(&self.loaded.name) == Some(&self.text) && self._home.is_none() {
            return Ok((self.loaded.name.clone(), set));
        }
        if self._home.is_none() && Path::new(&self.source).is_file() {
            return Ok((self.source.clone(), set));
        }
        let folder = match (&self.loaded.files, &self._home) {
            (Source::Folder(folder), Some(_)) => folder.clone(),
            _ => home,
        };
        let path = folder.join(format!("{}.toml", self.loaded.name));
        std::fs::write(&path, &self.text).map_err(Error::io(&path, "write"))?;
        Ok((path.display().to_string(), set))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let other = other.cast::<Scenario>();
        other.is_ok_and(|other| {
            let other = &other.get().loaded;
            other.scenario == self.loaded.scenario && other.name == self.loaded.name
        })
    }

    fn __hash__(&self) -> u64 {
        tofsim::files::digest::digest(0, self.text.as_bytes())
    }

    fn __repr__(&self) -> String {
        let set = self.loaded.set.join(", ");
        format!(
            "<tofsim.Scenario {}{}{set}>",
            self.loaded.name,
            if set.is_empty() { "" } else { ": " }
        )
    }

    fn _repr_html_(&self) -> Result<String> {
        Ok(pictures::scenario(&self.setup()?))
    }

    /// Travels as its text, with the files that it names.
    fn __reduce__<'py>(&self, py: Python<'py>) -> Result<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let Bundle { files, set } = Bundle::of(&self.loaded.files, &self.loaded.scenario)?;
        let files = (self.loaded.files != Source::BuiltIn || !files.is_empty()).then_some(files);
        let make = py.get_type::<Scenario>().getattr("_travelled")?;
        let set = [self.loaded.set.clone(), set].concat();
        let parts = (&self.loaded.name, &self.source, &self.text, set, files);
        Ok((make, parts.into_pyobject(py)?))
    }

    #[staticmethod]
    fn _travelled(
        name: &str,
        source: &str,
        text: &str,
        set: Vec<String>,
        files: Option<Files>,
    ) -> Result<Self> {
        let Some(files) = files else {
            return Scenario::parsed(name, source, text, Source::BuiltIn, &set);
        };
        let (home, folder) = Bundle { files, ..Bundle::default() }.unpack()?;
        let parsed = Scenario::parsed(name, source, text, Source::Folder(folder), &set)?;
        Ok(Scenario { _home: Some(Arc::new(home)), ..parsed })
    }
}

/// Names of the built-in scenarios.
#[pyfunction]
pub fn scenarios() -> Vec<&'static str> {
    builtin::scenarios().map(|(name, _)| name).collect()
}

/// Names of the built-in networks.
#[pyfunction]
pub fn networks() -> Vec<&'static str> {
    Trained::builtin_names().collect()
}
