//! Captures of the simulated firmware by a logic analyser, for timing diagrams.

use tofsim::error::{Input, Result};
use tofsim::sim::setup::Setup;
use tofsim_captures::ila::{AnalyserSetup, Capture};

use crate::page::scope;
use crate::page::trace::Trace;

use super::study::Study;
use super::values::Values;

/// Captures what a built-in probe configuration sees of its own scenario, with more keys set.
///
/// # Errors
/// When there is no such configuration, it never triggers, or the run is stopped.
pub fn captured(study: &Study, name: &str, set: &[&str]) -> Result<(Setup, Capture)> {
    capture(study, &AnalyserSetup::load(name)?, set)
}

/// Captures the same by the text of a probe configuration.
///
/// # Errors
/// As [`captured`].
pub fn captured_by(study: &Study, text: &str, set: &[&str]) -> Result<(Setup, Capture)> {
    capture(study, &AnalyserSetup::parse("scope", "set-up", text)?, set)
}

fn capture(study: &Study, set_up: &AnalyserSetup, set: &[&str]) -> Result<(Setup, Capture)> {
    let own = set_up.file.set.iter().map(String::as_str);
    let set: Vec<_> = own.chain(set.iter().copied()).collect();
    let setup = study.setup(&set_up.file.scenario, &set)?;
    let seen = scope::captured(&setup, set_up, study.stop())?;
    let seen = seen.ok_or_else(|| Input::new(&set_up.name, "never triggered"))?;
    Ok((setup, seen))
}

/// Returns, for each wave, its number of `rises`, the instant of the first one (`first_ns`), and its `high` samples.
pub fn of_trace(trace: &Trace) -> Values {
    let mut values = Values::default();
    for wave in &trace.waves {
        let (name, rises) = (&wave.name, trace.rises_ns(&wave.name));
        values.put(format!("{name}.rises"), rises.len() as f64);
        values.put(format!("{name}.first_ns"), rises.first().copied().unwrap_or(f64::NAN));
        values.put(format!("{name}.high"), trace.high(name) as f64);
    }
    values
}
