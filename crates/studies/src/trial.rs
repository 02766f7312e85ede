//! Simulation of one scenario with one seed.

use std::sync::atomic::AtomicBool;

use tofsim::error::{Result, poll_stop};
use tofsim::firmware::likelihood_estimator::targets::Targets;
use tofsim::network::Histogram;
use tofsim::note::{Note, NoteCode, merged};
use tofsim::scenario::Loaded;
use tofsim::sim::fast::histogram::Histograms;
use tofsim::sim::frames::Frame;
use tofsim::sim::image::ImageFidelity;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;
use tofsim::sim::{Run, domain};
use tofsim_learn::estimation::notes::notes_of_firmware;
use tofsim_learn::estimation::{Estimator, EstimatorKind, HistogramPair, Panel};

use crate::columns::{Column, Quantity};
use crate::echo::EchoShift;
use crate::errors::Errors;
use crate::figure::Figure;
use crate::images::Images;
use crate::plan::Plan;
use crate::plan::file::Fidelity;
use crate::tally::Tally;

/// Columns to compute for a plan's scenarios.
pub struct Trial<'a> {
    plan: &'a Plan,
    columns: Vec<&'a Column>,
    stop: Option<&'a AtomicBool>,
}

/// Result of a scenario.
pub struct Outcome {
    /// Value of each column.
    pub figures: Vec<Figure>,
    /// Notes on the values.
    pub notes: Vec<Note>,
}

impl<'a> Trial<'a> {
    /// Creates a trial that computes some columns; `stop` ends it.
    pub fn new(plan: &'a Plan, columns: Vec<&'a Column>, stop: Option<&'a AtomicBool>) -> Self {
        Trial { plan, columns, stop }
    }

    /// Simulates a scenario.
    ///
    /// # Errors
    /// If the scenario cannot be simulated at the plan's fidelity, or the sweep is stopped.
    pub fn measure(&self, loaded: Loaded) -> Result<Outcome> {
        if self.plan.is_of_array {
            return self.measure_images(loaded);
        }
        let setup = Setup::of_counts(loaded)?;
        let kinds = &self.plan.estimators;
        let simulates = self.plan.file.fidelity != Fidelity::Budget;
        let needs_frames = |column: &&Column| !matches!(column.quantity, Quantity::Expected(_));
        let simulates_frames = simulates && self.columns.iter().any(needs_frames);
        let measured = simulates_frames.then(|| self.simulate(&setup)).transpose()?;
        let figure = |column: &&Column| {
            Ok(match (column.quantity, &measured) {
                (Quantity::Expected(of), _) => Figure::new(finite(of(&setup)?), None),
                (Quantity::Hits(of), Some((tally, _))) => of(tally),
                (Quantity::Duration(of), Some((tally, _))) => Figure::new(Some(of(tally)), None),
                (Quantity::Errors(place, of), Some((_, errors))) => of(&errors[place]),
                _ => Figure::default(),
            })
        };
        let figures = self.columns.iter().map(figure).collect::<Result<_>>()?;
        let notes = if simulates {
            notes(&setup, kinds)?
        } else {
            setup.no_depth().cloned().into_iter().collect()
        };
        Ok(Outcome { figures, notes })
    }

    fn measure_images(&self, loaded: Loaded) -> Result<Outcome> {
        let (array, file) = (ArraySetup::new(loaded)?, &self.plan.file);
        let fidelity = match file.fidelity.stepping() {
            Some(stepping) => ImageFidelity::Shots(stepping),
            None => ImageFidelity::Histograms,
        };
        let pixels = array.images(fidelity, file.frames, self.stop, &|_| ())?;
        let mut notes = merged(pixels.iter().map(|pixel| &pixel.notes[..]));
        notes.extend(notes_of_firmware(array.common()));
        let images = Images::new(array, pixels, 1e-3 * file.outlier_limit_mm);
        let figure = |column: &&Column| match column.quantity {
            Quantity::ExpectedOfImages(of) | Quantity::OfImages(of) => of(&images),
            _ => Figure::default(),
        };
        Ok(Outcome { figures: self.columns.iter().map(figure).collect(), notes })
    }

    fn simulate(&self, setup: &Setup) -> Result<(Tally, Vec<Errors>)> {
        let plan = self.plan;
        let estimators = Panel::new(&plan.estimators, setup)?.into_estimators();
        let mut taker = Collector {
            truths_m: estimators.iter().map(|one| truth_m(setup, one.as_ref())).collect(),
            errors: estimators.iter().map(|_| Vec::new()).collect(),
            estimators,
            tally: Tally {
                echo: EchoShift::new(setup),
                cycle_ms: setup.cycle().seconds() * 1e3,
                ..Tally::default()
            },
            dark: None,
        };
        let frames = plan.file.frames * setup.frames_together();
        let mut take = |frame: &Frame| {
            taker.take(frame);
            Ok(())
        };
        match plan.file.fidelity {
            Fidelity::Budget => {}
            Fidelity::Histogram => {
                let histograms = Histograms::new(setup)?;
                for index in 0..frames {
                    poll_stop(self.stop)?;
                    take(&histograms.frame(index))?;
                }
            }
            fidelity @ (Fidelity::Shot | Fidelity::Cycle) => {
                let stepping = fidelity.stepping().unwrap_or_default();
                let frames_to =
                    Observers { frames: Some(&mut take), stop: self.stop, ..Observers::default() };
                Run::new(setup).stepping(stepping).observe(frames, frames_to)?;
            }
        }
        let limit_m = 1e-3 * plan.file.outlier_limit_mm;
        let of_each = taker.errors.iter().zip(&taker.truths_m);
        let errors = of_each.map(|(errors, truth_m)| Errors::of(errors, *truth_m, limit_m));
        Ok((taker.tally, errors.collect()))
    }
}

fn finite(value: Option<f64>) -> Option<f64> {
    value.filter(|value| value.is_finite())
}

/// Returns the distance of the target that an estimator reports first, if light reflected by it is simulated [m].
fn truth_m(setup: &Setup, estimator: &dyn Estimator) -> Option<f64> {
    let is_dark = setup.no_depth().is_some_and(|note| note.code == NoteCode::NoLight);
    let targets = estimator.second().map_or(Targets::One, |second| second.targets);
    (!is_dark).then(|| setup.depths_reported_by(targets).first_m)
}

/// Returns the notes on depths of a scenario.
fn notes(setup: &Setup, kinds: &[EstimatorKind]) -> Result<Vec<Note>> {
    if let Some(note) = setup.no_depth() {
        return Ok(vec![note.clone()]);
    }
    let mut notes = Vec::new();
    if kinds.iter().any(|kind| kind.is_network()) {
        notes = domain::notes(&setup.network, &setup.scenario, &[])?;
    }
    let are_networks = kinds.iter().all(|kind| kind.is_network());
    let drift = setup.drift_for(are_networks.then_some(&notes[..]));
    notes.extend(drift);
    notes.extend(kinds.iter().flat_map(|kind| kind.notes_of_scene(setup)));
    Ok(notes)
}

/// Collector of frames.
struct Collector {
    /// For each estimator, the distance of the target that it reports first [m].
    truths_m: Vec<Option<f64>>,
    estimators: Vec<Box<dyn Estimator>>,
    /// For each estimator, the depth error of each frame, if it has a depth [m].
    errors: Vec<Vec<Option<f64>>>,
    tally: Tally,
    dark: Option<Histogram>,
}

impl Collector {
    fn take(&mut self, frame: &Frame) {
        self.tally.take(frame);
        let is_dark_of_a_pair =
            !frame.laser_en && self.estimators.iter().any(|one| one.needs_dark());
        if is_dark_of_a_pair {
            self.dark = Some(frame.histogram.clone());
            return;
        }
        let pair =
            self.dark.take().map(|dark| HistogramPair { dark, lit: frame.histogram.clone() });
        let errors = self.errors.iter_mut().zip(&self.truths_m);
        for (estimator, (errors, truth_m)) in self.estimators.iter().zip(errors) {
            let found = match &pair {
                Some(pair) => estimator.estimate_pair(pair),
                None => estimator.estimate(&frame.histogram),
            };
            errors.push(found.ok().map(|depth_m| depth_m - truth_m.unwrap_or(0.0)));
        }
    }
}
