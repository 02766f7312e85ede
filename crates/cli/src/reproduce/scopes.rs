//! Captures of the simulated firmware by a logic analyser, for timing diagrams.

use tofsim::error::{Input, Result};
use tofsim::sim::setup::Setup;
use tofsim_captures::ila::{AnalyserSetup, Capture};

use crate::page::scope;

use super::study::Study;

/// What a set-up's analyser sees of its own scenario, with more keys set.
///
/// # Errors
/// When the set-up is none, never triggers, or the run is stopped.
pub fn captured(study: &Study, set_up: &AnalyserSetup, set: &[&str]) -> Result<(Setup, Capture)> {
    let own = set_up.file.set.iter().map(String::as_str);
    let set: Vec<_> = own.chain(set.iter().copied()).collect();
    let setup = study.setup(&set_up.file.scenario, &set)?;
    let seen = scope::captured(&setup, set_up, study.stop())?;
    let seen = seen.ok_or_else(|| Input::new(&set_up.name, "never triggered"))?;
    Ok((setup, seen))
}

/// The same by the text of a set-up.
///
/// # Errors
/// As [`captured`].
pub fn captured_by(study: &Study, text: &str, set: &[&str]) -> Result<(Setup, Capture)> {
    captured(study, &AnalyserSetup::parse("scope", "set-up", text)?, set)
}
