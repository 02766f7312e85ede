//! Captures of the simulated firmware by a logic analyser, for timing diagrams.

use tofsim::error::{Input, Result};
use tofsim::sim::Run;
use tofsim::sim::setup::Setup;
use tofsim_captures::ila::{Analyser, AnalyserPlan, AnalyserSetup, Capture, capture};

use super::study::Study;

/// What a set-up's analyser sees of its own scenario, with more keys set.
///
/// # Errors
/// When the set-up is none, never triggers, or the run is stopped.
pub fn captured(study: &Study, set_up: &AnalyserSetup, set: &[&str]) -> Result<(Setup, Capture)> {
    let own = set_up.file.set.iter().map(String::as_str);
    let set: Vec<_> = own.chain(set.iter().copied()).collect();
    let setup = study.setup(&set_up.file.scenario, &set)?;
    let plan = AnalyserPlan { stop_when_full: true, ..AnalyserPlan::new(set_up, &setup)? };
    let mut analyser = Analyser::new(&plan, &setup);
    capture(Run::new(&setup), set_up.file.frames, &mut analyser, study.stop())?;
    let seen = analyser.finish();
    match seen.samples() {
        0 => Err(Input::new(&set_up.name, "never triggered").into()),
        _ => Ok((setup, seen)),
    }
}

/// The same by the text of a set-up.
///
/// # Errors
/// As [`captured`].
pub fn captured_by(study: &Study, text: &str, set: &[&str]) -> Result<(Setup, Capture)> {
    captured(study, &AnalyserSetup::parse("scope", "set-up", text)?, set)
}
