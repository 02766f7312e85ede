//! `tofsim spad`: the modelled diode as a laboratory would measure it.

use tofsim::error::Result;
use tofsim::sim::free_running::FreeRunning;
use tofsim::sim::free_running::afterpulses::afterpulses;
use tofsim::sim::free_running::dark;
use tofsim::sim::free_running::rates::rates;
use tofsim::sim::setup::Setup;

use crate::report::spad::Characterisation;
use crate::report::writer::Report;

use super::options::{ResultArgs, ScenarioArgs};
use super::terminal::Console;

/// Characterise the SPAD model: count rate, dead time, afterpulses and dark counts
///
/// One diode runs freely (MODE 1) in constant light, by the same code as in a run. Count rates over four decades of
/// light are compared with the closed forms of both kinds of dead time; intervals and autocorrelation in faint light
/// measure the afterpulse probability, and counts in the dark the dark rate, each with its standard error. -o writes
/// spad.json, CSV files and pictures.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim spad\n  \
    tofsim spad -s spad.afterpulse_probability=0.05 -o spad")]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Number of counts per measurement
    #[arg(long, default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(5_000..=10_000_000))]
    counts: u64,
    #[command(flatten)]
    result: ResultArgs,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let setup = Setup::of_counts(args.scenario.load(None)?)?;
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
    args.result.deliver(&Report::new(found, &setup, &[], console), console)
}
