//! `tofsim evaluate`: how exactly estimators find the distance, beside the thesis.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

use serde_json::json;

use tofsim::error::{Input, Result};
use tofsim::files::output::create_directory_for;
use tofsim::network::Network;
use tofsim::scenario::{self, Loaded};
use tofsim::sim::setup::Setup;
use tofsim_learn::dataset::{Grid, HistogramSource, Scene};
use tofsim_learn::estimation::{Acquisition, EstimatorInputs, EstimatorKind, subtraction};
use tofsim_learn::evaluation::bound;
use tofsim_learn::evaluation::cross_check::CrossCheck;
use tofsim_learn::evaluation::thesis::{self, DISTANCES_M};
use tofsim_learn::evaluation::{Evaluation, Figures};

use crate::choice::words;
use crate::report::evaluation as report;

use super::draws::Draws;
use super::terminal::{Talk, print_json, stop_signal};

/// Light of the scenes that the cross-check takes: in the middle of the grid.
const CHECK_REFLECTANCE: f64 = 0.34;
/// See [`CHECK_REFLECTANCE`] [W/m^2/nm].
const CHECK_IRRADIANCE: f64 = 0.2;

/// Measure how exactly the network and other estimators find the distance
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Histograms are drawn afresh over the thesis's test grid: 51 distances from 0.1 \
    to 0.6 m, 9 irradiances,\n53 reflectances, 5 of each scene. All estimators see the same ones,\nbut for \
    subtraction: a dark and a lit one of half the shots each.\n\n\
    Examples:\n  \
    tofsim evaluate                                 the default network on its chain's bins\n  \
    tofsim evaluate ideal --profile ideal -o out    with box plots and tables as CSV\n  \
    tofsim evaluate --estimator network,peak,matched,likelihood --rows 12000\n  \
    tofsim evaluate --estimator peak,subtraction    does a dark histogram help the detector?"
)]
pub struct Args {
    /// Built-in network (uniform, uniform-16, ideal) or network file
    #[arg(value_name = "NETWORK", default_value = Network::DEFAULT)]
    network: String,
    /// Built-in scenario, or the path of a scenario file, for all but the scene
    #[arg(long, default_value = scenario::DEFAULT)]
    scenario: String,
    #[command(flatten)]
    draws: Draws,
    /// Estimators, separated by commas
    #[arg(long, value_parser = words(&EstimatorKind::ALL), value_delimiter = ',', default_value = "network,network-float")]
    estimator: Vec<EstimatorKind>,
    /// Frames to simulate cycle by cycle at each of six distances, to be compared with the fast path
    #[arg(long, value_name = "N", default_value_t = 8, allow_hyphen_values = true)]
    check: u64,
    /// Write evaluation.json, evaluation.csv and box plots of the errors there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
}

/// Runs the verb; the status says whether the cross-check found both paths the same.
pub fn run(args: &Args, talk: &Talk) -> Result<ExitCode> {
    let loaded = args.draws.load_with(&args.scenario, &args.network)?;
    let network = Network::find(&args.network, None)?;
    let setup = Setup::new(loaded.clone())?;
    let source = HistogramSource::new(&setup)?;
    let (seed, profile) = (loaded.scenario.seed, &loaded.scenario.tdc.profile);
    if file_name(&network.training.chain) != file_name(profile) {
        talk.note(format_args!(
            "note: {} was trained on the bins of chain {}, these are of {profile}",
            network.name, network.training.chain
        ));
    }
    let needs = EstimatorInputs {
        acquisition: Acquisition {
            bins: source.bins(),
            shots: source.shots().into(),
            pulse_sigma_ps: loaded.scenario.laser.pulse_sigma_ps,
        },
        network: &network,
        centroid: &setup.params.centroid_estimator,
    };
    let estimators = args.estimator.iter().map(|kind| kind.estimator(&needs));
    let estimators = estimators.collect::<std::result::Result<Vec<_>, Input>>()?;
    let rows = args.draws.rows(None, Grid::test(), seed);
    let look = |folder: &PathBuf| create_directory_for(folder, report::JSON);
    args.output.as_ref().map_or(Ok(()), look)?;
    let stop = stop_signal();
    let evaluation = args.draws.on_threads(rows.count(), talk, |done| {
        Evaluation::new(&source, &rows, seed, &estimators, stop.as_deref(), done)
    })?;
    let cross_check = args.cross_check(&loaded, &source, stop.as_deref())?;
    let figures: Vec<_> =
        evaluation.columns.iter().map(|column| Figures::new(&evaluation, column)).collect();
    let bound_mm = bound::two_sd_mm(&source, &needs.acquisition, &Grid::test(), &DISTANCES_M)?;
    let json = json!({
        "schema": "tofsim.evaluate/1",
        "version": env!("CARGO_PKG_VERSION"),
        "network": network.name,
        "scenario": loaded.name,
        "profile": profile,
        "seed": seed,
        "rows": rows.count(),
        "shots_per_frame": source.shots(),
        "estimators": figures,
        // At the thesis's distances, light unknown.
        "cramer_rao_two_sd_mm": bound_mm,
        "cross_check": cross_check,
        "thesis": {
            "distances_m": DISTANCES_M,
            "float_two_sd_mm": thesis::FLOAT.two_sd_mm,
            "fixed_two_sd_mm": thesis::FIXED.two_sd_mm,
        },
    });
    if let Some(folder) = &args.output {
        let written = report::write(folder, &format!("{json}\n"), &figures)?;
        written.iter().for_each(|path| talk.wrote(path));
    }
    if args.json {
        print_json(&json)?;
    } else {
        let head = format!(
            "network {}, chain {profile}, scenario {}, {} histograms of {} shots, seed {seed}\n\n",
            network.name,
            loaded.name,
            rows.count(),
            source.shots()
        );
        talk.report(&(head + &text(&figures, &bound_mm, source.shots(), &cross_check)))?;
    }
    let agrees = cross_check.iter().all(CrossCheck::agrees);
    Ok(if agrees { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

impl Args {
    fn cross_check(
        &self,
        loaded: &Loaded,
        source: &HistogramSource,
        stop: Option<&AtomicBool>,
    ) -> Result<Vec<CrossCheck>> {
        let distances: &[f64] = if self.check > 0 { &DISTANCES_M } else { &[] };
        let scene = |&distance_m| Scene {
            distance_m,
            reflectance: CHECK_REFLECTANCE,
            irradiance_w_m2_nm: CHECK_IRRADIANCE,
        };
        let check = |scene| CrossCheck::new(loaded, source, &scene, self.check, stop);
        distances.iter().map(scene).map(check).collect()
    }
}

/// A chain's name, wherever its file is.
fn file_name(profile: &str) -> &OsStr {
    Path::new(profile).file_name().unwrap_or(profile.as_ref())
}

fn text(
    figures: &[Figures],
    bound_mm: &[Option<f64>],
    shots: u16,
    checks: &[CrossCheck],
) -> String {
    let mut text = report::tables(figures, bound_mm);
    if figures.iter().any(|one| one.name == subtraction::NAME) {
        let shots = shots / 2;
        text += &format!("\n{}: {shots} dark and {shots} lit shots each\n", subtraction::NAME);
    }
    text += "\n";
    for line in figures.iter().filter_map(report::beside_the_line) {
        text += &(line + "\n");
    }
    for check in checks {
        text += &format!(
            "{} frames cycle by cycle at {} m: counts as drawn, p = {:.3}; other depths: {}{}\n",
            check.frames,
            check.distance_m,
            check.p_value,
            check.other_depths,
            if check.agrees() { "" } else { "  DIFFERENT" },
        );
    }
    text
}
