//! Network files: TOML texts with weights, number formats and provenance.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Input, Result, read_text};
use crate::firmware::depth_estimator::datapath::Datapath;

use super::domain::Domain;
use super::float::Float;
use super::unrounded::Unrounded;
use super::weights::Fixed;

/// A network with the metadata of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    /// Built-in name, or the file's path.
    pub name: String,
    /// Description, in a sentence.
    pub description: String,
    /// Provenance.
    pub training: Training,
    /// Training domain, if known.
    pub domain: Option<Domain>,
    /// Measured accuracy, if known.
    pub accuracy: Option<Accuracy>,
    /// Number formats of the firmware.
    pub datapath: Datapath,
    /// Fixed-point weights.
    pub fixed: Fixed,
    /// Weights before rounding.
    pub float: Unrounded,
}

/// Provenance of a network.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Training {
    /// Recipe and data, in words.
    pub origin: String,
    /// Carry chain of the training data.
    pub chain: String,
    /// Command that repeats the training, if known.
    pub command: Option<String>,
    /// Seed of the data and of the initial weights.
    pub seed: Option<u64>,
    /// Hash of all training histograms.
    pub data: Option<String>,
}

/// Measured errors of the fixed-point depth on a test set.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Accuracy {
    /// Distances tested [m].
    pub distances_m: Vec<f64>,
    /// Two standard deviations of the depth at each [mm].
    pub two_sd_mm: Vec<f64>,
    /// Mean error of the depth at each [mm].
    pub mean_mm: Option<Vec<f64>>,
}

/// Header of the last section of a file.
pub(super) const FLOAT_SECTION: &str = "\n[float]\n";

/// Name and file text of each built-in network.
const BUILTIN: &[(&str, &str)] = &[
    ("uniform", include_str!("../../stimuli/networks/uniform.toml")),
    ("ideal", include_str!("../../stimuli/networks/ideal.toml")),
    ("uniform-16", include_str!("../../stimuli/networks/uniform-16.toml")),
    ("long", include_str!("../../stimuli/networks/long.toml")),
    ("fine", include_str!("../../stimuli/networks/fine.toml")),
    ("compact", include_str!("../../stimuli/networks/compact.toml")),
    ("ecp5", include_str!("../../stimuli/networks/ecp5.toml")),
];

impl Network {
    /// Name of the default network.
    pub const DEFAULT: &str = "uniform";

    /// Returns the names of the built-in networks.
    pub fn builtin_names() -> impl Iterator<Item = &'static str> {
        BUILTIN.iter().map(|(name, _)| *name)
    }

    /// Returns the file text of a built-in network.
    pub fn builtin_text(name: &str) -> Option<&'static str> {
        BUILTIN.iter().find(|(builtin, _)| *builtin == name).map(|(_, text)| *text)
    }

    /// Loads a built-in network; returns `None` if there is none of that name.
    pub fn builtin(name: &str) -> Option<Result<Network>> {
        // A sweep makes thousands of setups.
        static PARSED: Mutex<BTreeMap<&str, Network>> = Mutex::new(BTreeMap::new());
        let (name, text) = BUILTIN.iter().find(|(builtin, _)| *builtin == name)?;
        let mut parsed = PARSED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(network) = parsed.get(name) {
            return Some(Ok(network.clone()));
        }
        // Three quarters of the text are weights before rounding, which a run does not need.
        let (integers, float) = text.split_once(FLOAT_SECTION).unwrap_or((text, ""));
        let network = Network::parse(integers, name)
            .map(|network| Network { float: Unrounded::BuiltIn(float), ..network });
        network.iter().for_each(|network| drop(parsed.insert(name, network.clone())));
        Some(network)
    }

    /// Loads a network from a file.
    ///
    /// # Errors
    /// If the file cannot be read, or is not a network file.
    pub fn load(path: &Path) -> Result<Network> {
        Network::parse(&read_text(path)?, &path.display().to_string())
    }

    /// Loads a network by built-in name or path; a relative path starts from `base`, if given.
    ///
    /// # Errors
    /// If there is no such network, or its file is invalid.
    pub fn find(name: &str, base: Option<&Path>) -> Result<Network> {
        if let Some(builtin) = Network::builtin(name) {
            return builtin;
        }
        let path = base.map_or_else(|| Path::new(name).to_owned(), |base| base.join(name));
        Network::load(&path).map_err(|error| match error {
            Error::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                let names = Network::builtin_names().collect::<Vec<_>>().join(", ");
                Input::new(path.display(), format!("no such file; built-in networks are {names}"))
                    .into()
            }
            other => other,
        })
    }

    /// Returns the weights in double precision: those before rounding if known, otherwise the values of the integers.
    pub fn twin(&self) -> Float {
        let from_fixed = || Float::from_fixed(&self.fixed, &self.datapath);
        self.float.get().map_or_else(from_fixed, Cow::into_owned)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_files_are_as_the_writer_lays_them_out() {
        for name in Network::builtin_names() {
            let network = Network::builtin(name).unwrap().unwrap();
            assert!(Network::builtin_text(name).unwrap() == network.to_toml(), "{name}");
        }
    }

    #[test]
    fn a_name_that_is_neither_built_in_nor_a_file_lists_the_built_in_ones() {
        let error = Network::find("unifrom", None).unwrap_err().to_string();
        assert!(
            error.contains("unifrom") && error.contains("uniform, ideal, uniform-16"),
            "{error}"
        );
    }
}
