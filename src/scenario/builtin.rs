//! Instruments, scenarios, carry chains and stimuli that are built into the program.

use std::path::PathBuf;

use crate::error::{Result, read_bytes, read_text};

macro_rules! files {
    ($folder:literal, $extension:literal: $($name:literal),* $(,)?) => {
        &[$((
            $name,
            include_str!(concat!("../../stimuli/", $folder, "/", $name, ".", $extension)),
        ),)*]
    };
}

/// Name and text of each built-in instrument.
const INSTRUMENTS: &[(&str, &str)] =
    files!("instruments", "toml": "kc705", "long", "fine", "compact", "ecp5");

/// Name and text of each other built-in scenario.
const SCENARIOS: &[(&str, &str)] = files!("scenarios", "toml":
    "near", "far", "bright", "fog", "glass", "net", "step", "array",
    "spad_validation", "tdc_validation", "histogram_validation", "estimator_validation",
);

/// Name and text of each built-in chain.
pub const CHAINS: &[(&str, &str)] =
    files!("chains", "toml": "uniform", "table6_3", "ideal", "kintex7", "ecp5");

/// Files that built-in scenarios refer to.
const STIMULI: &[(&str, &str)] = &[
    ("../photons/tdc_validation.csv", include_str!("../../stimuli/photons/tdc_validation.csv")),
    ("../codes/kc705.csv", include_str!("../../stimuli/codes/kc705.csv")),
    ("../histograms/kc705.csv", include_str!("../../stimuli/histograms/kc705.csv")),
    ("../chains/columns.csv", include_str!("../../stimuli/chains/columns.csv")),
    ("../meshes/table.obj", include_str!("../../stimuli/meshes/table.obj")),
];

fn find(files: &[(&'static str, &'static str)], name: &str) -> Option<&'static str> {
    files.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// Name and text of each built-in scenario: of the KC705 first, other instruments' last.
pub fn scenarios() -> impl Iterator<Item = (&'static str, &'static str)> {
    let (kc705, others) = INSTRUMENTS.split_at(1);
    kc705.iter().chain(SCENARIOS).chain(others).copied()
}

/// The text of a built-in scenario.
pub fn scenario(name: &str) -> Option<&'static str> {
    scenarios().find(|(known, _)| *known == name).map(|(_, text)| text)
}

/// The text of a built-in chain.
pub fn chain(name: &str) -> Option<&'static str> {
    find(CHAINS, name)
}

/// The origin of the files that a scenario names.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Files built into the program.
    BuiltIn,
    /// Files below a folder, which is that of the scenario's own file.
    Folder(PathBuf),
}

impl Source {
    /// Reads the text file `name`, and returns its full name and its text.
    ///
    /// # Errors
    /// If there is no such file, or it is not UTF-8.
    pub fn read(&self, name: &str) -> Result<(String, String)> {
        if let Some((name, text)) = self.built_in(name) {
            return Ok((name, text.into()));
        }
        let path = self.path(name);
        Ok((path.display().to_string(), read_text(&path)?))
    }

    /// Reads the file `name`, which may be binary, and returns its full name and its bytes.
    ///
    /// # Errors
    /// If there is no such file.
    pub fn read_bytes(&self, name: &str) -> Result<(String, Vec<u8>)> {
        if let Some((name, text)) = self.built_in(name) {
            return Ok((name, text.into()));
        }
        let path = self.path(name);
        Ok((path.display().to_string(), read_bytes(&path)?))
    }

    /// Returns the full name and the text of a built-in file. In a folder that has no such file, it stands for that, so
    /// that a built-in scenario can be saved and used anywhere.
    fn built_in(&self, name: &str) -> Option<(String, &'static str)> {
        let text = find(STIMULI, name)?;
        let is_used = *self == Source::BuiltIn || !self.path(name).exists();
        is_used.then(|| (name.trim_start_matches("../").to_owned(), text))
    }

    fn path(&self, name: &str) -> PathBuf {
        match self {
            Source::BuiltIn => PathBuf::from(name),
            Source::Folder(folder) => folder.join(name),
        }
    }
}
