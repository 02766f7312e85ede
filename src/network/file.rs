//! The network file: a TOML text with weights, their formats and where they come from.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Input, Result, read_text};
use crate::firmware::depth_estimator::datapath::Datapath;

use super::domain::Domain;
use super::float::Float;
use super::weights::Fixed;

/// A network and what its file says about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    /// Built-in name, or the file's path.
    pub name: String,
    /// What it is, in a sentence.
    pub description: String,
    /// How it came about.
    pub training: Training,
    /// What it was trained for, if the file says.
    pub domain: Option<Domain>,
    /// Errors measured, if any were.
    pub accuracy: Option<Accuracy>,
    /// The formats of the firmware's words.
    pub datapath: Datapath,
    /// The weights of the firmware.
    pub fixed: Fixed,
    /// The weights before rounding, if the file has them.
    pub float: Option<Float>,
}

/// How a network came about.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Training {
    /// Recipe and data, in words.
    pub origin: String,
    /// Chain whose bins it was trained on.
    pub chain: String,
    /// Command that trains it again, if there is one.
    pub command: Option<String>,
    /// Seed of the data and the starts.
    pub seed: Option<u64>,
    /// Hash of all histograms that it was trained on.
    pub data: Option<String>,
}

/// Spread of the fixed-point depth over a test set.
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

/// Networks that come with the program: name and file.
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
    /// Name of the network used when none is given.
    pub const DEFAULT: &str = "uniform";

    /// Names of the networks that come with the program.
    pub fn builtin_names() -> impl Iterator<Item = &'static str> {
        BUILTIN.iter().map(|(name, _)| *name)
    }

    /// Text of the file of a network that comes with the program.
    pub fn builtin_text(name: &str) -> Option<&'static str> {
        BUILTIN.iter().find(|(builtin, _)| *builtin == name).map(|(_, text)| *text)
    }

    /// A network that comes with the program; `None` if it has none of that name.
    pub fn builtin(name: &str) -> Option<Result<Network>> {
        // A sweep makes thousands of setups.
        static PARSED: Mutex<BTreeMap<&str, Network>> = Mutex::new(BTreeMap::new());
        let (name, text) = BUILTIN.iter().find(|(builtin, _)| *builtin == name)?;
        let mut parsed = PARSED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(network) = parsed.get(name) {
            return Some(Ok(network.clone()));
        }
        let network = Network::parse(text, name);
        network.iter().for_each(|network| drop(parsed.insert(name, network.clone())));
        Some(network)
    }

    /// A network from a file.
    pub fn load(path: &Path) -> Result<Network> {
        Network::parse(&read_text(path)?, &path.display().to_string())
    }

    /// A network by built-in name or path; a relative path starts from `base`, if given.
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

    /// The weights in double precision: those before rounding, or else the values of the integers.
    pub fn twin(&self) -> Float {
        self.float.clone().unwrap_or_else(|| Float::from_fixed(&self.fixed, &self.datapath))
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
