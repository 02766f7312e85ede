//! Samples of a run, as a logic analyser takes them, for a timing diagram.

use std::sync::atomic::AtomicBool;

use tofsim::error::Result;
use tofsim::sim::Run;
use tofsim::sim::setup::Setup;
use tofsim_captures::ila::{Analyser, AnalyserPlan, AnalyserSetup, Capture, capture};

/// The samples of a set-up in a run of `setup`; nothing if it never triggers.
///
/// # Errors
/// When the set-up is not for the design, or the run is stopped.
pub fn captured(
    setup: &Setup,
    set_up: &AnalyserSetup,
    stop: Option<&AtomicBool>,
) -> Result<Option<Capture>> {
    let plan = AnalyserPlan { stop_when_full: true, ..AnalyserPlan::new(set_up, setup)? };
    let mut analyser = Analyser::new(&plan, setup);
    capture(Run::new(setup), set_up.file.frames, &mut analyser, stop)?;
    let is_triggered = !analyser.triggers().is_empty();
    Ok(is_triggered.then(|| analyser.finish()))
}
