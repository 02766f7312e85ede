//! An evaluation on histograms from files, whose distances are known.

use std::path::Path;

use serde_json::json;

use tofsim::Note;
use tofsim::error::{Input, Result};
use tofsim::files::folder::FolderLock;
use tofsim::sim::domain;
use tofsim::sim::setup::Setup;
use tofsim_learn::dataset::axis::thinned;
use tofsim_learn::dataset::{Labelled, Scene};
use tofsim_learn::estimation::{Needs, Panel};
use tofsim_learn::evaluation::{EstimatorErrors, Evaluation, Figures};

use crate::report::evaluation::{self as report, EvaluationFindings};
use crate::report::writer::Report;
use crate::verbs::pixel::columns_of_counts;
use crate::verbs::terminal::Console;

use super::args::{Args, SHOWN};

/// Evaluates what is in `data`.
pub fn run(args: &Args, data: &Path, console: &Console) -> Result<()> {
    let loaded = args.draws.load_with(&args.scenario, args.network.as_deref(), &args.draws.set)?;
    let size = loaded.scenario.histogram();
    let labelled = Labelled::read(data, args.truth.as_deref(), &size)?;
    labelled.check(data, &loaded.scenario)?;
    let (setup, columns) = columns_of_counts(loaded)?;
    check_columns(data, &labelled, &setup)?;
    let notes = args.notes_on(&setup, &labelled)?;
    console.print_notes(&notes)?;
    if args.estimator.iter().any(|kind| kind.needs() == Needs::Dark) {
        let expected = "expected estimators of a single histogram: it also needs a dark one";
        return Err(Input::new("--estimator", expected).value("subtraction").into());
    }
    let held = args.output.as_deref().map(FolderLock::take).transpose()?;
    let panel = |setup: &Setup| Ok(Panel::new(&args.estimator, setup)?.into_estimators());
    let estimators = columns.iter().map(panel).collect::<Result<Vec<_>>>()?;
    let count = labelled.histograms.len() as u64;
    let evaluation = args.draws.on_threads(count, console, |done| {
        let of = |scene: &Scene| &estimators[scene.pixel % estimators.len()][..];
        let evaluation = Evaluation::of_histograms(&labelled, of);
        done(count);
        Ok(evaluation)
    })?;
    let limit_m = 1e-3 * args.outlier_limit_mm;
    let of = |column: &EstimatorErrors| figures(&evaluation, column, limit_m, &labelled);
    let figures: Vec<_> = evaluation.columns.iter().map(of).collect();
    let (profile, network) = (&setup.scenario.tdc.profile, &setup.network.name);
    let json = json!({
        "network": network,
        "profile": profile,
        "data": data.display().to_string(),
        "rows": count,
        "estimators": figures,
    });
    let data = data.display();
    let head = format!("network {network}, chain {profile}, {count} histograms of {data}\n\n");
    let distances = figures.first().map_or(&[][..], |one| &one.by_distance_m);
    let distances: Vec<f64> = distances.iter().map(|group| group.value).collect();
    let shown = thinned(&distances, SHOWN);
    let beside = report::Beside { distances_m: &shown, bound_mm: &[], thesis: false };
    let tables = match labelled.array {
        None => "\n".to_owned() + &report::tables(&figures, &beside),
        Some(_) => report::image_table(&figures),
    };
    let tables = report::overview(&figures) + &tables;
    let (text, figures) = (head + &tables, &figures[..]);
    let findings = EvaluationFindings { json, text, figures, bound: &[], grid: None };
    drop(held);
    Report::new(findings, &setup, &notes, console).deliver(
        args.output.as_deref(),
        args.json,
        console,
    )
}

/// Checks that the column of each histogram is known, where each has a chain of its own.
///
/// # Errors
/// When the histograms are not those of as many columns as the scenario has.
fn check_columns(data: &Path, labelled: &Labelled, setup: &Setup) -> Result<()> {
    let array = &setup.scenario.array;
    let found = labelled.array.map_or(1, |[_, columns]| columns);
    if array.chains_file.is_none() || found == array.columns as usize {
        return Ok(());
    }
    let expected = format!(
        "expected {}, as array.columns has it: each has a chain of its own (array.chains_file)",
        array.columns
    );
    Err(Input::new(data.display(), expected).field("columns").value(found).into())
}

/// The figures of an estimator; the thesis's line is for its own scenes.
fn figures(
    evaluation: &Evaluation,
    column: &EstimatorErrors,
    limit_m: f64,
    labelled: &Labelled,
) -> Figures {
    let mut figures = Figures::new(evaluation, column, limit_m);
    if let Some(size) = labelled.array {
        figures = figures.of_array(evaluation, column, size, limit_m);
    }
    (figures.worst_ratio_to_thesis, figures.worst_distance_m) = (None, None);
    if !labelled.knows_light {
        figures.most_biased_scene = None;
        figures.by_scene.clear();
        figures.by_reflectance.clear();
        figures.by_irradiance_w_m2_nm.clear();
    }
    figures
}

impl Args {
    /// Returns the notes on histograms outside of the network's training, and on a chain that has drifted.
    fn notes_on(&self, setup: &Setup, labelled: &Labelled) -> Result<Vec<Note>> {
        let mut notes = Vec::new();
        if self.measures_a_network() {
            notes = domain::notes(&setup.network, &setup.scenario, &labelled.ranges())?;
        }
        let of_all = self.measures_networks_only().then_some(&notes[..]);
        let drift = setup.drift_for(of_all);
        Ok(drift.into_iter().chain(notes).collect())
    }
}
