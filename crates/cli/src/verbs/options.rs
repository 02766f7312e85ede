//! Options that several verbs have.

use std::path::PathBuf;

use tofsim::error::Result;
use tofsim::scenario::{self, Loaded};

use crate::report::writer::{Findings, Report};

use super::draws::load;
use super::terminal::Console;

/// The scenario of a verb.
#[derive(Clone, Debug, clap::Args)]
pub struct ScenarioArgs {
    /// Built-in scenario, or the path of a scenario file (see `scenario list`)
    #[arg(value_name = "SCENARIO", default_value = scenario::DEFAULT)]
    pub scenario: String,
    /// Set a scenario key, e.g. `tdc.profile=kintex7`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

impl ScenarioArgs {
    /// Loads the scenario with its keys set, and with a seed instead of its own if there is one.
    pub fn load(&self, seed: Option<u64>) -> Result<Loaded> {
        load(&self.scenario, &self.set, seed)
    }
}

/// Destination of results.
#[derive(Clone, Debug, clap::Args)]
pub struct ResultArgs {
    /// Write JSON, CSV and pictures into this folder (docs/files.md describes them)
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Print one JSON object instead of tables
    #[arg(long)]
    pub json: bool,
}

impl ResultArgs {
    /// Writes and prints a report.
    ///
    /// # Errors
    /// When a picture cannot be drawn, or something cannot be written.
    pub fn deliver<F: Findings>(&self, report: &Report<F>, console: &Console) -> Result<()> {
        report.deliver(self.output.as_deref(), self.json, console)
    }
}
