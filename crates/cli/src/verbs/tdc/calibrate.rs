//! `tofsim tdc calibrate`: the decoder's ROM from measured counts.

use std::path::PathBuf;

use tofsim::error::{Result, read_text};
use tofsim::files::output::write_bytes;
use tofsim::scenario;
use tofsim::scenario::chain::measured;
use tofsim::sim::setup::Setup;
use tofsim_learn::characterisation::rom::CalibratedRom;

use crate::record::Record;
use crate::report::tdc_rom::csv;
use crate::report::writer::Report;

use crate::verbs::terminal::Talk;

/// Make the decoder's ROM from the counts of a code-density test, with standard errors
///
/// The hits must be uncorrelated with the clock, such as those of ambient light. The delay to tap 0, which no count
/// shows, is taken from the scenario's chain.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim tdc calibrate counts.csv --scenario mine.toml -o cal.csv\n  \
    tofsim run mine.toml -s tdc.calibration=cal.csv")]
pub struct Args {
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
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    let setup = Setup::of_counts(scenario::load(&args.scenario, &args.set)?)?;
    let source = args.counts.display().to_string();
    let counts = measured::counts(&source, &read_text(&args.counts)?)?;
    let rom = CalibratedRom::new(&source, &counts, &setup.params.tdc)?;
    let notes: Vec<_> = rom.note().into_iter().collect();
    talk.heed(&notes)?;
    if let Some(path) = &args.output {
        write_bytes(path, Record::new(&setup, &talk.command).comment_line() + &csv(&rom))?;
        talk.wrote(path);
    }
    Report::new(rom, &setup, &notes, talk).deliver(None, args.json, talk)
}
