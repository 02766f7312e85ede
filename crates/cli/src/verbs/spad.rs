//! `tofsim spad`: the modelled diode as a laboratory would measure it.

use std::path::PathBuf;

use tofsim::error::Result;
use tofsim::scenario;
use tofsim::sim::free_running::FreeRunning;
use tofsim::sim::free_running::afterpulses::afterpulses;
use tofsim::sim::free_running::dark;
use tofsim::sim::free_running::rates::rates;
use tofsim::sim::setup::Setup;

use crate::report::spad::Characterisation;
use crate::report::writer::Report;

use super::terminal::Talk;

/// Characterise the modelled diode: count rate, dead time, afterpulses and dark counts
///
/// One diode runs freely (MODE 1) in constant light, by the same code as in a run. Count rates over four
/// decades of light stand beside the closed forms of both kinds of dead time; intervals and autocorrelation in
/// faint light give the afterpulse probability back, and the dark gives its rate, each with its standard error.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim spad\n  \
    tofsim spad -s spad.afterpulse_probability=0.05 -s spad.temperature_c=40 -o spad")]
pub struct Args {
    /// Built-in scenario, or the path of a scenario file (see `scenario list`)
    #[arg(default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a key of the scenario, such as spad.dead_time_ns=50; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Counts of each measurement
    #[arg(long, default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(5_000..=10_000_000))]
    counts: u64,
    /// Write spad.json, CSV files and pictures into this folder
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    let setup = Setup::of_counts(scenario::load(&args.scenario, &args.set)?)?;
    let diode = FreeRunning::new(&setup);
    let dark_hz = setup.dark.one_hz();
    let found = Characterisation {
        counts: args.counts,
        spad: &setup.scenario.spad,
        dark_hz,
        points: rates(&diode, args.counts),
        afterpulses: afterpulses(&diode, dark_hz, args.counts),
        dark: dark::dark_rate_hz(&diode, dark_hz, args.counts / 10),
    };
    Report::new(found, &setup, &[], talk).deliver(args.output.as_deref(), args.json, talk)
}
