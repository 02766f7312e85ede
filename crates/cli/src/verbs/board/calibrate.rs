//! `tofsim board calibrate`: the decoder's ROM from a board's own code density.

use std::path::PathBuf;

use tofsim::error::Result;
use tofsim::network::mem::{digits, lines};
use tofsim::sim::setup::Setup;
use tofsim_learn::characterisation::rom::CalibratedRom;

use crate::record::Record;
use crate::report::sheet::Digits::Shortest;
use crate::report::sheet::Sheet;
use crate::report::tdc_rom::csv;
use crate::report::writer::Report;
use crate::verbs::options::ScenarioArgs;
use crate::verbs::terminal::{Console, stop_signal};

use super::connection::{ParametersArgs, PortArgs};

/// Measure the code density with the board's ring oscillator, and compute the decoder's ROM, with standard errors
///
/// The laser is off. The delay to tap 0, which counts cannot measure, is that of the scenario's chain. -o writes
/// tdc_cal.mem for the firmware, calibration.csv for tdc.calibration, and counts.csv for `tofsim tdc calibrate`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim board calibrate -s tdc.profile=kintex7 --port /dev/ttyUSB0 -o cal\n  \
    tofsim run -s tdc.profile=kintex7 -s tdc.calibration=cal/calibration.csv")]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    #[command(flatten)]
    port: PortArgs,
    #[command(flatten)]
    parameters: ParametersArgs,
    /// Hits to count at least
    #[arg(long, value_name = "N", default_value_t = 1 << 20)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=4_000_000_000))]
    hits: u32,
    /// Write tdc_cal.mem, calibration.csv and counts.csv into this folder
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let setup = Setup::of_counts(args.scenario.load(None)?)?;
    let mut board = args.port.open(&setup, args.parameters)?;
    let stop = stop_signal();
    let progress = console.progress(args.hits.into(), "hits");
    let mut before = 0;
    let mut counted = |now: u32| {
        progress.inc(now.saturating_sub(before).into());
        before = before.max(now);
    };
    let counts = board.code_density(&setup, args.hits, stop.as_deref(), &mut counted)?;
    progress.finish_and_clear();
    let rom = CalibratedRom::new(board.port(), &counts, &setup.params.tdc)?;
    let notes: Vec<_> = rom.note().into_iter().collect();
    console.print_notes(&notes)?;
    if let Some(folder) = &args.output {
        let line = Record::new(&setup, &console.command).comment_line();
        let words = rom.entries.iter().map(|entry| entry.units);
        let mem = lines(words, digits(setup.params.tdc.decoder.age_bits()));
        let rows: Vec<_> = counts.iter().enumerate().collect();
        let sheet = Sheet::of(&rows);
        let sheet = sheet.column("n", Shortest, |(n, _)| *n);
        let counts = sheet.column("count", Shortest, |(_, count)| **count).csv();
        let (rom, counts) = (line.clone() + &csv(&rom), line + &counts);
        let files = [("tdc_cal.mem", mem), ("calibration.csv", rom), ("counts.csv", counts)];
        console.write_into(folder, files)?;
    }
    Report::new(rom, &setup, &notes, console).deliver(None, args.json, console)
}
