//! The files of an instrument, as they go into a build's folder: the scenario with what it names beside it.

use std::path::{Path, PathBuf};

use toml_edit::{DocumentMut, Item, Table, value};

use tofsim::error::{Error, Input, Result, read_text};
use tofsim::files::output::write_bytes;
use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::scenario::builtin::{self, Source};
use tofsim::scenario::{self, Loaded, Scenario};
use tofsim_learn::training::recipe::Recipe;

use crate::verbs::train;

/// The network's file in the folder.
pub const NETWORK: &str = "network.toml";
const CHAIN: &str = "chain.toml";
const RECIPE: &str = "recipe.toml";
/// Files that hold what a stimulus says, by key.
const STIMULI: [&str; 3] = ["photons", "codes", "histogram"];

/// The scenario of an instrument, and the files that it names.
pub struct InstrumentFiles {
    /// The scenario as given.
    pub loaded: Loaded,
    /// The scenario's file, and others, in the folder.
    pub files: Vec<(String, String)>,
    original: PathBuf,
}

impl InstrumentFiles {
    /// Reads a scenario file, or a built-in scenario.
    ///
    /// # Errors
    /// When it is no scenario, or a file that it names cannot be read.
    pub fn read(name: &str) -> Result<Self> {
        let mut loaded = scenario::load(name, &[])?;
        if let Source::Folder(folder) = &mut loaded.files {
            // The build works in a folder of its own.
            *folder = std::path::absolute(Path::new(".").join(&*folder))
                .map_err(Error::io(folder, "read"))?;
        }
        let text = match builtin::scenario(name) {
            Some(text) => text.to_owned(),
            None => read_text(Path::new(name))?,
        };
        let fault = |error: toml_edit::TomlError| Input::new(name, error);
        let mut document: DocumentMut = text.parse().map_err(fault)?;
        let mut files = Vec::new();
        let Scenario { tdc, stimulus, estimator, .. } = &loaded.scenario;
        if estimator.kind == FirmwareEstimator::Network {
            set(&mut document, "estimator", "network", NETWORK);
        }
        if builtin::chain(&tdc.profile).is_none() && tdc.profile.contains(['/', '.']) {
            files.push((CHAIN.to_owned(), loaded.files.read(&tdc.profile)?.1));
            set(&mut document, "tdc", "profile", CHAIN);
        }
        let own = [&stimulus.photons, &stimulus.codes, &stimulus.histogram];
        for (key, file) in STIMULI.into_iter().zip(own) {
            if let Some(file) = file {
                files.push((format!("{key}.csv"), loaded.files.read(file)?.1));
                set(&mut document, "stimulus", key, &format!("{key}.csv"));
            }
        }
        let is_named = |it: &&str| *it == train::QUICK || Recipe::builtin_text(it).is_some();
        let recipe = loaded.scenario.training.recipe.as_deref();
        if let Some(recipe) = recipe.filter(|recipe| !is_named(recipe)) {
            let path = match &loaded.files {
                Source::Folder(folder) => folder.join(recipe),
                Source::BuiltIn => PathBuf::from(recipe),
            };
            files.push((RECIPE.to_owned(), train::read_recipe(&path)?));
            set(&mut document, "training", "recipe", RECIPE);
        }
        files.insert(0, (format!("{}.toml", loaded.name), document.to_string()));
        Ok(InstrumentFiles { loaded, files, original: PathBuf::from(name) })
    }

    /// Checks that the original is not in the folder under the name of its copy.
    ///
    /// # Errors
    /// When it has.
    pub fn check_folder(&self, folder: &Path) -> Result<()> {
        let copy = folder.join(&self.files[0].0);
        let is_same = match (copy.canonicalize(), self.original.canonicalize()) {
            (Ok(copy), Ok(original)) => copy == original,
            _ => false,
        };
        let taken = [NETWORK, CHAIN, RECIPE];
        if let Some(name) = taken.into_iter().find(|name| *name == self.files[0].0) {
            let expected = format!(
                "expected another name than {}: a build has a {name} of its own",
                taken.join(", ")
            );
            return Err(Input::new("INSTRUMENT", expected).value(self.original.display()).into());
        }
        if is_same && self.loaded.scenario.estimator.network != NETWORK {
            let expected = "expected another folder than the file's own: its copy goes there";
            return Err(Input::new("--output", expected).value(folder.display()).into());
        }
        Ok(())
    }

    /// Writes them into a folder.
    ///
    /// # Errors
    /// When one cannot be written.
    pub fn write(&self, folder: &Path) -> Result<()> {
        for (name, text) in &self.files {
            let path = folder.join(name);
            if !std::fs::read_to_string(&path).is_ok_and(|found| found == *text) {
                write_bytes(&path, text)?;
            }
        }
        Ok(())
    }

    /// The text of the network that it names, if there is one: a built-in name, or a file that is there.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn network(&self) -> Result<Option<(String, String)>> {
        let name = &self.loaded.scenario.estimator.network;
        if let Some(text) = tofsim::network::Network::builtin_text(name) {
            return Ok(Some((name.clone(), text.to_owned())));
        }
        match self.loaded.files.read(name) {
            Ok((_, text)) => Ok(Some((name.clone(), text))),
            Err(Error::Io { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// The scenario as the folder has it, but for its network.
    pub fn with_any_network(&self) -> Loaded {
        let mut loaded = self.loaded.clone();
        loaded.scenario.estimator.network = tofsim::network::Network::DEFAULT.to_owned();
        loaded
    }
}

fn set(document: &mut DocumentMut, table: &str, key: &str, to: &str) {
    let table = document.entry(table).or_insert(Item::Table(Table::new()));
    if let Some(table) = table.as_table_like_mut() {
        table.insert(key, value(to));
    }
}
