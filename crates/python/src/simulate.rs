//! `tofsim.simulate`: frames of a scenario, as arrays.

use std::sync::Arc;

use pyo3::prelude::*;

use tofsim::error::Input;
use tofsim::{Frame, HistogramRun, Observers, Outcome, Run, Setup, Shot};
use tofsim_cli::choice::Fidelity;
use tofsim_cli::report::causes;
use tofsim_cli::verbs::frames::{check, check_streams};
use tofsim_learn::estimation::notes::notes_of_firmware;

use crate::errors::Result;
use crate::frames::{Columns, Frames};
use crate::running::{self, Terms, Watch};
use crate::scenario::Scenario;

/// The fidelity of that name.
///
/// # Errors
/// When there is none.
pub fn fidelity_of(name: &str) -> Result<Fidelity> {
    let found = Fidelity::ALL.iter().find(|(word, ..)| *word == name);
    let known = || Fidelity::ALL.map(|(word, ..)| word).join(", ");
    let fault = || Input::new("fidelity", format!("expected one of {}", known())).value(name);
    Ok(found.ok_or_else(fault)?.1)
}

/// Simulates frames: photons to depth. Of dark and lit frames `frames` counts the pairs.
///
/// `by_cause` counts the hits of each bin by what set them off too, which takes fidelity `cycle` and one thread.
/// `progress` is called with how many frames of how many are done.
// As many as Python's function has.
#[allow(clippy::too_many_arguments)]
#[pyfunction]
#[pyo3(signature = (scenario = None, frames = 1, fidelity = "cycle", seed = None, threads = None, *, by_cause = false, progress = None))]
pub fn simulate(
    py: Python<'_>,
    scenario: Option<&Bound<'_, PyAny>>,
    frames: u64,
    fidelity: &str,
    seed: Option<u64>,
    threads: Option<usize>,
    by_cause: bool,
    progress: Option<Py<PyAny>>,
) -> Result<Frames> {
    let fidelity = fidelity_of(fidelity)?;
    if by_cause && fidelity != Fidelity::Cycle {
        let expected = "expected False, or fidelity=\"cycle\": there are no single shots";
        return Err(Input::new("by_cause", expected).value("True").into());
    }
    if frames == 0 {
        return Err(Input::new("frames", "expected 1 at least").value(0).into());
    }
    let loaded = Scenario::of(scenario)?.seeded(seed);
    let terms = Terms { threads, progress };
    let (setup, columns) = running::run(py, terms, move |watch| {
        let setup = Arc::new(Setup::new(loaded)?);
        match fidelity {
            Fidelity::Histogram => check_streams("frames", frames, &setup)?,
            _ => check("frames", frames, &setup)?,
        }
        let mut notes = setup.notes()?;
        notes.extend(notes_of_firmware(&setup));
        let count = frames * setup.frames_together();
        let mut columns = Columns::new(&setup, count, by_cause)?;
        let outcome = simulated(&setup, fidelity, count, &mut columns, watch)?;
        notes.extend(outcome.notes);
        columns.notes = notes;
        Ok((setup, columns))
    })?;
    Frames::new(py, setup, columns)
}

fn simulated(
    setup: &Setup,
    fidelity: Fidelity,
    count: u64,
    columns: &mut Columns,
    watch: &Watch,
) -> tofsim::Result<Outcome> {
    let is_by_cause = columns.causes.is_some();
    let mut by_cause = columns.causes.take();
    let mut take_shot = |shot: &Shot| {
        by_cause
            .iter_mut()
            .for_each(|frames| causes::count(&mut frames[shot.frame as usize], shot));
        Ok(())
    };
    let mut take_frame = |frame: &Frame| {
        watch.add(count);
        columns.push(frame);
        Ok(())
    };
    let observers = Observers {
        shots: is_by_cause.then_some(&mut take_shot),
        frames: Some(&mut take_frame),
        stop: Some(&watch.stop),
        ..Observers::default()
    };
    let run = || Run::new(setup).stepping(fidelity.stepping());
    let outcome = match fidelity {
        Fidelity::Histogram => HistogramRun::new(setup)?.many(count, observers)?,
        _ if is_by_cause => run().observe(count, observers)?,
        _ => run().many(count, observers)?,
    };
    columns.causes = by_cause;
    Ok(outcome)
}
