//! `tofsim tdc`: what a TDC is like, as papers report it.

mod drift;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Subcommand;

use tofsim::error::{Input, Result, read_text};
use tofsim::files::output::write_bytes;
use tofsim::scenario;
use tofsim::scenario::chain::measured;
use tofsim::sim::setup::Setup;
use tofsim_learn::characterisation::Characterisation;
use tofsim_learn::characterisation::decoders::Comparison;
use tofsim_learn::characterisation::rom::CalibratedRom;

use crate::record::Record;
use crate::report::decoders::DecoderFindings;
use crate::report::tdc::TdcFindings;
use crate::report::tdc_rom::csv;
use crate::report::writer::Report;

use super::options::{ResultArgs, ScenarioArgs};
use super::terminal::Console;

/// Characterise the TDC: bin widths, DNL, INL, bubbles, precision, clock edges
///
/// The code-density test counts hits uncorrelated with the clock; exact bin widths are listed for comparison. Exit
/// status 1 means that a hit is off by a period of the clock. -o writes bins.csv, counts.csv, transfer.csv, tdc.json and
/// SVG.
#[derive(Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true)]
#[command(after_help = "Examples:\n  \
    tofsim tdc -s tdc.profile=kintex7 -o tdc         realistic carry chain\n  \
    tofsim tdc -s tdc.profile=kintex7 -s tdc.calibration=uniform\n  \
    tofsim tdc --decoders -s tdc.profile=kintex7     compare the decoders\n  \
    tofsim tdc calibrate tdc/counts.csv -s tdc.profile=kintex7 -o cal.csv\n  \
    tofsim run -s tdc.profile=kintex7 -s tdc.calibration=cal.csv")]
pub struct Args {
    #[command(subcommand)]
    verb: Option<Verb>,
    #[command(flatten)]
    own: OwnArgs,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Calibrate(CalibrateArgs),
    Drift(drift::Args),
}

#[derive(Debug, clap::Args)]
struct OwnArgs {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Number of hits of the code-density test, and of random times
    #[arg(long, default_value_t = 1_000_000, value_name = "N")]
    #[arg(value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    hits: u64,
    #[command(flatten)]
    result: ResultArgs,
    /// Compare the decoders on the same hits; -o writes decoders.csv, patterns.csv, decoders.json and decoders.svg
    #[arg(long)]
    decoders: bool,
}

/// Runs the verb; the status says whether no hit is off by a period of the clock.
pub fn run(args: &Args, console: &Console) -> Result<ExitCode> {
    match &args.verb {
        Some(Verb::Calibrate(args)) => calibrate(args, console).map(|()| ExitCode::SUCCESS),
        Some(Verb::Drift(args)) => drift::run(args, console).map(|()| ExitCode::SUCCESS),
        None => args.own.run(console),
    }
}

impl OwnArgs {
    fn run(&self, console: &Console) -> Result<ExitCode> {
        let setup = Setup::of_counts(self.scenario.load(None)?)?;
        if let Some(file) = &setup.scenario.tdc.conditions {
            let expected = "expected none: a chain is characterised under constant conditions";
            return Err(Input::new("scenario", expected)
                .field("tdc.conditions")
                .value(file)
                .into());
        }
        if self.decoders {
            return self.compare(&setup, console);
        }
        let converter = (&setup.params.tdc, setup.disturbance());
        let found = Characterisation::new(converter, self.hits, setup.scenario.seed);
        let findings = TdcFindings { found: &found, setup: &setup };
        let report = Report::new(findings, &setup, &[], console);
        self.result.deliver(&report, console)?;
        let is_right = found.is_coarse_right();
        Ok(if is_right { ExitCode::SUCCESS } else { ExitCode::FAILURE })
    }

    /// Compares the decoders themselves, so that the scenario's own and its calibration play no part.
    fn compare(&self, setup: &Setup, console: &Console) -> Result<ExitCode> {
        let found = Comparison::new(&setup.params.tdc, self.hits, setup.scenario.seed);
        let report = Report::new(DecoderFindings { found: &found, setup }, setup, &[], console);
        self.result.deliver(&report, console)?;
        Ok(ExitCode::SUCCESS)
    }
}

/// Compute the decoder's ROM from the counts of a code-density test, with standard errors
///
/// The hits must be uncorrelated with the clock, such as those of ambient light. The delay to tap 0, which counts
/// cannot measure, is that of the scenario's chain.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim tdc calibrate counts.csv --scenario mine.toml -o cal.csv\n  \
    tofsim run mine.toml -s tdc.calibration=cal.csv")]
struct CalibrateArgs {
    /// Counts: CSV with header n,count and a row for each number of ones, from 0 on
    #[arg(value_name = "COUNTS.csv")]
    counts: PathBuf,
    /// Built-in scenario, or the path of a scenario file: clock, bins, and the chain's offset
    #[arg(long, default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a scenario key, e.g. `tdc.profile=kintex7`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Write the file that tdc.calibration reads
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
fn calibrate(args: &CalibrateArgs, console: &Console) -> Result<()> {
    let setup = Setup::of_counts(scenario::load(&args.scenario, &args.set)?)?;
    let source = args.counts.display().to_string();
    let counts = measured::counts(&source, &read_text(&args.counts)?)?;
    let rom = CalibratedRom::new(&source, &counts, &setup.params.tdc)?;
    let notes: Vec<_> = rom.note().into_iter().collect();
    console.print_notes(&notes)?;
    if let Some(path) = &args.output {
        write_bytes(path, Record::new(&setup, &console.command).comment_line() + &csv(&rom))?;
        console.wrote(path);
    }
    Report::new(rom, &setup, &notes, console).deliver(None, args.json, console)
}
