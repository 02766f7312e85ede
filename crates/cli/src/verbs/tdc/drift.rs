//! `tofsim tdc drift`: the depth while the die heats up.

use std::path::PathBuf;

use tofsim::error::{Result, read_text};
use tofsim::files::output::create_directory_for;
use tofsim::scenario::drift::{DIE_C, Profile};
use tofsim::sim::domain;
use tofsim::sim::setup::Setup;
use tofsim_learn::drift::{Drift, Plan};
use tofsim_learn::estimation::EstimatorKind;

use crate::choice::{seed, threads, words};
use crate::report::tdc_drift::DriftFindings;
use crate::report::writer::Report;

use crate::verbs::draws::use_threads;
use crate::verbs::options::{ResultArgs, ScenarioArgs};
use crate::verbs::terminal::{Console, stop_signal};

/// Show the depth error over time as the die heats up, with a TDC calibrated once and one calibrated repeatedly
///
/// Delays of the chain grow with temperature (tdc.delay_per_c) and fall with the supply (tdc.delay_per_mv); a
/// calibration holds the delays at its time. -o writes drift.csv, drift.json and drift.svg.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim tdc drift -s tdc.profile=kintex7         25 to 65 degC in ten minutes\n  \
    tofsim tdc drift --every 10 --estimator likelihood_estimator -o drift\n  \
    tofsim tdc drift mine.toml --temperatures log.csv   logged temperatures")]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Temperatures over time: CSV with header time_s,temperature_c,supply_mv, instead of a ramp
    #[arg(long, value_name = "FILE", conflicts_with_all = ["from", "to", "over", "points"])]
    temperatures: Option<PathBuf>,
    /// Temperature at the start of the ramp [degC]
    #[arg(long, value_name = "C", default_value_t = 25.0, value_parser = celsius)]
    from: f64,
    /// Temperature at the end of the ramp [degC]
    #[arg(long, value_name = "C", default_value_t = 65.0, value_parser = celsius)]
    to: f64,
    /// Duration of the ramp [s]
    #[arg(long, value_name = "S", default_value_t = 600.0, value_parser = seconds)]
    over: f64,
    /// Number of evenly spaced moments of the ramp
    #[arg(long, value_name = "N", default_value_t = 21, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    points: u32,
    /// Interval between calibrations [s]
    #[arg(long, value_name = "S", default_value_t = 60.0, value_parser = seconds)]
    every: f64,
    /// Histograms per moment and calibration
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    repeats: u64,
    /// Estimator of the depths [default: the one in the scenario's estimator slot]
    #[arg(long, value_parser = words(EstimatorKind::ALL))]
    estimator: Option<EstimatorKind>,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N", value_parser = seed())]
    seed: Option<u64>,
    /// Threads; the results are the same for any number [default: one a core]
    #[arg(long, value_name = "N", value_parser = threads())]
    threads: Option<u16>,
    #[command(flatten)]
    result: ResultArgs,
}

/// A temperature that the part is made for.
fn celsius(text: &str) -> std::result::Result<f64, String> {
    let value = text.parse().ok().filter(|value| DIE_C.contains(value));
    value.ok_or_else(|| {
        format!("expected {} to {} degC, the part's range", DIE_C.start(), DIE_C.end())
    })
}

/// A duration above 0.
fn seconds(text: &str) -> std::result::Result<f64, String> {
    let value = text.parse().ok().filter(|value| *value > 0.0 && *value <= 1e9);
    value.ok_or_else(|| "expected more than 0, and 1e9 s at most".to_owned())
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    use_threads(args.threads)?;
    let loaded = args.scenario.load(args.seed)?;
    let tdc = &loaded.scenario.tdc;
    let profile = match &args.temperatures {
        Some(path) => Profile::parse(&path.display().to_string(), &read_text(path)?)?,
        None => {
            let moments = args.points as usize;
            Profile::ramp(args.from, args.to, args.over, moments, tdc.supply_mv)
        }
    };
    let setup = Setup::of_counts(loaded.clone())?;
    let kind = args.estimator.unwrap_or(EstimatorKind::in_socket(&loaded.scenario));
    let mut notes = kind.notes(&setup);
    if kind.is_network() {
        let temperatures = [("tdc.temperature_c", profile.temperatures_c())];
        notes.extend(domain::notes(&setup.network, &loaded.scenario, &temperatures)?);
    }
    console.print_notes(&notes)?;
    let look = |folder: &PathBuf| create_directory_for(folder, "drift.json");
    args.result.output.as_ref().map_or(Ok(()), look)?;
    let plan = Plan { kind, every_s: args.every, repeats: args.repeats };
    let progress =
        console.progress(2 * args.repeats * profile.moments().len() as u64, "histograms");
    let stop = stop_signal();
    let found = Drift::new(&loaded, &profile, plan, stop.as_deref(), |more| progress.inc(more));
    progress.finish_and_clear();
    let found = found?;
    let report =
        Report::new(DriftFindings { found: &found, setup: &setup }, &setup, &notes, console);
    args.result.deliver(&report, console)
}
