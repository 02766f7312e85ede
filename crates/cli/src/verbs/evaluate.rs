//! `tofsim evaluate`: how exactly estimators find the distance, beside the thesis.

use std::path::PathBuf;
use std::process::ExitCode;

use serde_json::{Value, json};

use tofsim::Note;
use tofsim::error::{Input, Result};
use tofsim::files::folder::FolderLock;
use tofsim::files::output::create_directory_for;
use tofsim::network::Network;
use tofsim::note::NoteCode;
use tofsim::scenario::Loaded;
use tofsim::scenario::effects::Method;
use tofsim::sim::domain;
use tofsim::sim::setup::Setup;
use tofsim_learn::dataset::axis::thinned;
use tofsim_learn::dataset::{Grid, GridPurpose, Scene};
use tofsim_learn::estimation::{Estimator, EstimatorInputs, EstimatorKind, subtraction};
use tofsim_learn::evaluation::bound;
use tofsim_learn::evaluation::cross_check::CrossCheck;
use tofsim_learn::evaluation::thesis::{self, DISTANCES_M};
use tofsim_learn::evaluation::{Evaluation, Figures};

use crate::report::evaluation::{self as report, EvaluationFindings};
use crate::report::writer::Report;
use crate::text::table::width;
use crate::text::wrap::wrapped;

use super::scenes::Scenes;
use super::terminal::{Console, stop_signal};

mod args;
mod cross_checks;
mod measured;

pub use args::Args;
use args::SHOWN;

/// Estimators of one setting, or of one of its columns.
type Estimators = Vec<Box<dyn Estimator>>;

/// Runs the verb; the status says whether the cross-check found both paths the same.
pub fn run(args: &Args, console: &Console) -> Result<ExitCode> {
    let args = &args.with_estimators()?;
    if let Some(data) = &args.data {
        measured::run(args, data, console)?;
        return Ok(ExitCode::SUCCESS);
    }
    let load = |set: &[String]| args.draws.load_with(&args.scenario, args.network.as_deref(), set);
    let scenes = Scenes::new(&args.grid, &args.draws.set, GridPurpose::Test, load)?;
    let (grid, source) = (Grid { repeats: args.repeats, ..scenes.grid.clone() }, &scenes.source);
    let network = &scenes.setups[0].network;
    let seed = scenes.loaded[0].scenario.seed;
    let mut notes = args.notes(&scenes, network)?;
    notes.extend(args.notes_of_estimators(&scenes)?);
    console.print_notes(&notes)?;
    let estimators = args.estimators(&scenes, network)?;
    let rows = args.draws.rows(None, &grid, seed)?;
    let held = args.output.as_deref().map(FolderLock::take).transpose()?;
    let look = |folder: &PathBuf| create_directory_for(folder, "evaluation.json");
    args.output.as_ref().map_or(Ok(()), look)?;
    let stop = stop_signal();
    let evaluation = args.draws.on_threads(rows.count(), console, |done| {
        let of = |scene: &Scene| {
            let columns = &estimators[scene.setting];
            &columns[scene.pixel % columns.len()][..]
        };
        Evaluation::with(source, &rows, seed, of, stop.as_deref(), done)
    })?;
    let of = |column| Figures::over(&evaluation, column, &grid, 1e-3 * args.outlier_limit_mm);
    let figures: Vec<_> = evaluation.columns.iter().map(of).collect();
    let drawn = figures.first().map_or(&[][..], |one| &one.by_distance_m);
    let drawn: Vec<f64> = drawn.iter().map(|group| group.value).collect();
    let is_thesis = grid.is_thesis();
    let shown = if is_thesis { DISTANCES_M.to_vec() } else { thinned(&drawn, SHOWN) };
    let cross_check = args.cross_check(&scenes, &shown, stop.as_deref())?;
    let bound_at = if is_thesis { &shown } else { &drawn };
    let bound_mm = bound::two_sd_mm(source, &grid, bound_at)?;
    // The picture has it at all distances.
    let pictured_mm = match &args.output {
        Some(_) if is_thesis => bound::two_sd_mm(source, &grid, &drawn)?,
        Some(_) => bound_mm.clone(),
        None => Vec::new(),
    };
    let bound = drawn.iter().zip(pictured_mm);
    let bound: Vec<_> = bound.filter_map(|(&m, mm)| Some((m, mm?))).collect();
    let bound_mm = bound_at.iter().copied().zip(bound_mm).collect();
    let drawn = Drawn { scenes: &scenes, grid: &grid, rows: rows.count(), bound_mm, shown };
    let findings = EvaluationFindings {
        json: drawn.json(args, &figures, &cross_check),
        text: drawn.text(&figures, &cross_check),
        figures: &figures,
        bound: &bound,
        grid: Some(&grid),
    };
    drop(held);
    let report = Report::new(findings, &scenes.setups[0], &notes, console);
    report.deliver(args.output.as_deref(), args.json, console)?;
    let agrees = cross_check.iter().all(CrossCheck::agrees);
    Ok(if agrees { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Histograms that were drawn over a grid.
struct Drawn<'a> {
    scenes: &'a Scenes,
    grid: &'a Grid,
    /// Number of histograms.
    rows: u64,
    /// The Cramer-Rao bound at some distances [m, mm].
    bound_mm: Vec<(f64, Option<f64>)>,
    /// Distances of the tables [m].
    shown: Vec<f64>,
}

impl Drawn<'_> {
    fn json(&self, args: &Args, figures: &[Figures], cross_check: &[CrossCheck]) -> Value {
        let (grid, setup) = (self.grid, &self.scenes.setups[0]);
        let mut json = json!({
            "network": setup.network.name,
            "profile": self.scenes.loaded[0].scenario.tdc.profile,
            "rows": self.rows,
            "shots_per_frame": self.scenes.source.shots_of_all(),
            "outlier_limit_mm": args.outlier_limit_mm,
            "estimators": figures,
            // At the thesis's distances, or those of your own grid; light unknown.
            "cramer_rao_two_sd_mm": self.bound_mm.iter().map(|(_, mm)| mm).collect::<Vec<_>>(),
            "cross_check": cross_check,
        });
        if let Some(array) = &grid.array {
            json["array"] = json!({ "rows": array.rows, "columns": array.columns });
        }
        if grid.is_thesis() {
            json["thesis"] = json!({
                "distances_m": DISTANCES_M,
                "float_two_sd_mm": thesis::FLOAT.two_sd_mm,
                "fixed_two_sd_mm": thesis::FIXED.two_sd_mm,
            });
        } else {
            json["grid"] =
                json!({ "axes": grid.axes().collect::<Vec<_>>(), "repeats": grid.repeats });
            json["distances_m"] = self.bound_mm.iter().map(|(m, _)| *m).collect();
        }
        json
    }

    fn text(&self, figures: &[Figures], cross_check: &[CrossCheck]) -> String {
        let Loaded { name, scenario, .. } = &self.scenes.loaded[0];
        let shots = self.scenes.source.shots_of_all();
        let head = format!(
            "network {}, chain {}, scenario {name}, seed {}\n{} histograms{}\n\n",
            self.scenes.setups[0].network.name,
            scenario.tdc.profile,
            scenario.seed,
            self.rows,
            shots.map_or(String::new(), |shots| format!(" of {shots} shots")),
        );
        let at = |m: &f64| self.bound_mm.iter().find(|(known, _)| known == m)?.1;
        let bound_mm: Vec<_> = self.shown.iter().map(at).collect();
        let thesis = self.grid.is_thesis();
        let beside = report::Beside { distances_m: &self.shown, bound_mm: &bound_mm, thesis };
        let tables = match self.grid.array {
            None => "\n".to_owned() + &report::tables(figures, &beside),
            Some(_) => report::image_table(figures),
        };
        let tables = report::overview(figures)
            + &tables
            + &report::setting_tables(figures)
            + &report::biased_scenes(figures);
        let lacks_bound = bound_mm.contains(&None) || self.grid.array.is_some();
        let no_bound = if lacks_bound { self.no_bound() } else { String::new() };
        head + &tables + &no_bound + &text(figures, shots, cross_check)
    }

    /// Returns the reason for a distance without a Cramer-Rao bound, as a paragraph.
    fn no_bound(&self) -> String {
        if self.grid.array.is_some() {
            let line = "No Cramer-Rao bound: the light on a pixel is not a single echo";
            return format!("\n{}\n", wrapped(line, width(), ["", "  "]));
        }
        let why = |setup: &Setup| setup.why_not(Method::CramerRaoBound);
        let why = self.scenes.setups.iter().find_map(why).unwrap_or("no laser light returns");
        let line = format!("No Cramer-Rao bound where there is a dash: {why}");
        format!("\n{}\n", wrapped(&line, width(), ["", "  "]))
    }
}

impl Args {
    /// Returns the notes on some scenes: outside of the network's training, if it is
    /// measured, and of what can be found.
    fn notes(&self, scenes: &Scenes, network: &Network) -> Result<Vec<Note>> {
        let mut notes = scenes.notes()?;
        // Drift is below, for the estimators that are measured.
        notes.retain(|note| note.code != NoteCode::ChainDrifted);
        let mut of_network = Vec::new();
        if self.measures_a_network() {
            let scenario = &scenes.loaded[0].scenario;
            of_network = domain::notes(network, scenario, &scenes.grid.ranges())?;
        }
        let of_all = self.measures_networks_only().then_some(&of_network[..]);
        // Of several conditions the first that is another than that of the calibration.
        notes.extend(scenes.setups.iter().find_map(|setup| setup.drift_for(of_all)));
        notes.extend(of_network);
        Ok(notes)
    }

    /// Returns the notes on the estimators' models: of all scenes, and of the nearest and the farthest.
    fn notes_of_estimators(&self, scenes: &Scenes) -> Result<Vec<Note>> {
        let middle = scenes.setups.len() / 2;
        if scenes.grid.array.is_some() {
            let notes =
                self.estimator.iter().map(|kind| kind.notes_of_scene(&scenes.setups[middle]));
            return Ok(notes.flatten().collect());
        }
        let of = |setup: &Setup| self.estimator.iter().flat_map(|kind| kind.notes(setup)).collect();
        let mut notes: Vec<Note> = of(&scenes.setups[middle]);
        for distance_m in scenes.grid.distances_m.range() {
            let mut loaded = scenes.loaded[middle].clone();
            loaded.scenario.target.distance_m = distance_m;
            let setup = Setup::of_counts(loaded)?;
            let of_scene = self.estimator.iter().flat_map(|kind| kind.notes_of_scene(&setup));
            notes.extend(of_scene.filter(|note| note.key == "target.distance_m"));
        }
        Ok(notes)
    }

    /// The same with the estimators of the scenario's firmware, where none is named.
    fn with_estimators(&self) -> Result<Self> {
        let mut args = self.clone();
        if args.estimator.is_empty() {
            let loaded = self.draws.load_with(&self.scenario, None, &self.draws.set)?;
            let own = EstimatorKind::in_socket(&loaded.scenario);
            let is_network = own.is_network() || self.network.is_some();
            let networks = vec![EstimatorKind::Network, EstimatorKind::NetworkFloat];
            args.estimator = if is_network { networks } else { vec![own] };
        }
        Ok(args)
    }

    fn measures_a_network(&self) -> bool {
        self.estimator.iter().any(|kind| kind.is_network())
    }

    fn measures_networks_only(&self) -> bool {
        self.estimator.iter().all(|kind| kind.is_network())
    }

    /// The estimators for the histograms of each setting: one set for all pixels, or for the chain of each column.
    fn estimators(&self, scenes: &Scenes, network: &Network) -> Result<Vec<Vec<Estimators>>> {
        let of_column = |setting: usize, pixel: usize, setup: &Setup| {
            let scene = Scene { setting, pixel, ..Scene::default() };
            let acquisition = scenes.source.acquisition_of(&scene);
            let needs = EstimatorInputs { acquisition, network, setup };
            let estimators = self.estimator.iter().map(|kind| kind.estimator(&needs));
            Ok(estimators.collect::<std::result::Result<Vec<_>, Input>>()?)
        };
        let of_setting = |(setting, setup): (usize, &Setup)| {
            if self.measures_a_network() {
                setup.check_network()?;
            }
            let Some(array) = scenes.arrays.get(setting) else {
                return Ok(vec![of_column(setting, 0, setup)?]);
            };
            let columns = array.columns().into_iter().enumerate();
            columns.map(|(column, setup)| of_column(setting, column, &setup)).collect()
        };
        scenes.setups.iter().enumerate().map(of_setting).collect()
    }
}

fn text(figures: &[Figures], shots: Option<u32>, checks: &[CrossCheck]) -> String {
    let mut text = String::new();
    if figures.iter().any(|one| one.name == subtraction::NAME) {
        let shots = shots.map_or("half the".to_owned(), |shots| (shots / 2).to_string());
        text += &format!("\n{}: {shots} dark and {shots} lit shots each\n", subtraction::NAME);
    }
    text += &report::beside_the_line(figures);
    text + &cross_checks::text(checks)
}
