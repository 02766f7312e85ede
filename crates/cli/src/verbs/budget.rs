//! `tofsim budget`: the link budget of a scenario, what a shot can expect, and the laser's class; or which effect
//! makes its depth wrong by how much.

use std::path::PathBuf;

use tofsim::Setup;
use tofsim::error::{Input, Result};
use tofsim::files::output::create_directory_for;
use tofsim::scenario::Loaded;
use tofsim_learn::dataset::Axis;
use tofsim_learn::error_budget::Plan;
use tofsim_learn::estimation::EstimatorKind;

use crate::choice::{seed, words};
use crate::report::error_budget::DepthBudgets;
use crate::report::link_budget::LinkBudget;
use crate::report::writer::Report;

use super::draws::{load, use_threads};
use super::options::ScenarioArgs;
use super::terminal::{Console, stop_signal};

/// Print the link budget: photons and avalanches that a shot can expect, and eye safety
///
/// With --errors, print the depth error budget: the contributions of shot noise, pile-up, ambient light, pulse,
/// jitter, TDC taps and their calibration, and word lengths to bias and spread.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim budget near\n  \
    tofsim budget --errors -s tdc.profile=kintex7\n  \
    tofsim budget --errors --grid target.distance_m=0.1..0.6:0.1 -o out")]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    errors: ErrorArgs,
}

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    if args.errors.errors {
        return args.errors.run(&args.scenario, args.json, console);
    }
    let setup = Setup::of_counts(args.scenario.load(None)?)?;
    let findings = LinkBudget::of(setup.clone());
    let notes = findings.notes()?;
    Report::new(findings, &setup, &notes, console).deliver(None, args.json, console)?;
    console.print_notes(&notes)
}

/// The options that go with `--errors`.
#[derive(Debug, clap::Args)]
pub struct ErrorArgs {
    /// Print the depth error budget instead: bias and spread with every effect off, with each alone, with all but
    /// each, and with all
    #[arg(long)]
    pub errors: bool,
    /// With --errors: estimator to analyse [default: the one in the firmware's estimator slot]
    #[arg(long, requires = "errors", value_parser = words(EstimatorKind::ALL))]
    estimator: Option<EstimatorKind>,
    /// With --errors: number of frames for each variant
    #[arg(long, requires = "errors", value_name = "N", default_value_t = 1000)]
    #[arg(value_parser = clap::value_parser!(u64).range(2..=10_000_000))]
    frames: u64,
    /// With --errors: a budget at each value of a key, such as target.distance_m=0.1..0.6:0.1 or
    /// target.reflectance=0.08,0.34
    #[arg(long, requires = "errors", value_name = "KEY=VALUES")]
    grid: Option<String>,
    /// With --errors: seed of every random stream, instead of the scenario's
    #[arg(long, requires = "errors", value_name = "N", value_parser = seed())]
    seed: Option<u64>,
    /// With --errors: threads; the results are the same for any number [default: one a core]
    #[arg(long, requires = "errors", value_name = "N")]
    #[arg(value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// With --errors: write errors.json, errors.csv and errors.svg into this folder
    #[arg(short, long, requires = "errors", value_name = "DIR")]
    output: Option<PathBuf>,
}

impl ErrorArgs {
    /// Measures and reports.
    pub fn run(&self, scenario: &ScenarioArgs, as_json: bool, console: &Console) -> Result<()> {
        use_threads(self.threads)?;
        let axis = self.grid.as_deref().map(|grid| Axis::parse("--grid", grid)).transpose()?;
        let plans = self.plans(scenario, axis.as_ref())?;
        let Some((_, first)) = plans.first() else {
            return Err(Input::new("--grid", "expected one value at least").into());
        };
        let mut notes = Vec::new();
        for (_, plan) in &plans {
            let new = plan.notes()?.into_iter().filter(|note| !notes.contains(note));
            notes.extend(new.collect::<Vec<_>>());
        }
        console.print_notes(&notes)?;
        let look = |folder: &PathBuf| create_directory_for(folder, "errors.json");
        self.output.as_ref().map_or(Ok(()), look)?;
        let stop = stop_signal();
        let frames = plans.iter().map(|(_, plan)| plan.frames(self.frames)).sum();
        let progress = console.progress(frames, "frames");
        let done = |more| progress.inc(more);
        let measure = |(value, plan): &(f64, Plan)| {
            Ok((*value, plan.measure(self.frames, stop.as_deref(), &done)?))
        };
        let measured: Result<Vec<_>> = plans.iter().map(measure).collect();
        progress.finish_and_clear();
        let key = axis.as_ref().map(|axis| axis.key.as_str());
        let budgets = DepthBudgets { key, points: &measured? };
        let report = Report::new(budgets, first.setup(), &notes, console);
        report.deliver(self.output.as_deref(), as_json, console)
    }

    /// Plans the measurement at each value of the grid's key, or at the scenario's distance.
    fn plans(&self, scenario: &ScenarioArgs, axis: Option<&Axis>) -> Result<Vec<(f64, Plan)>> {
        let set = &scenario.set;
        let plan = |value: Option<(&str, f64)>| {
            let more = value.map(|(key, value)| format!("{key}={value}"));
            let set_here: Vec<_> = set.iter().cloned().chain(more).collect();
            let loaded = load(&scenario.scenario, &set_here, self.seed)?;
            let loaded = Loaded { set: set.clone(), ..loaded };
            let in_socket = || EstimatorKind::in_socket(&loaded.scenario);
            let kind = self.estimator.unwrap_or_else(in_socket);
            let distance_m = loaded.scenario.target.distance_m;
            Ok((value.map_or(distance_m, |(_, value)| value), Plan::new(&loaded, kind)?))
        };
        let Some(axis) = axis else { return Ok(vec![plan(None)?]) };
        let own = |text: &&String| text.split('=').next().is_some_and(|key| key.trim() == axis.key);
        if let Some(text) = set.iter().find(own) {
            let expected = format!("expected no -s of {}, which --grid has", axis.key);
            return Err(Input::new("-s", expected).value(text).into());
        }
        axis.values.iter().map(|&value| plan(Some((axis.key.as_str(), value)))).collect()
    }
}
