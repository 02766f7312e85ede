//! `tofsim wave convert` and `tofsim wave cut`.

use std::path::PathBuf;

use tofsim::error::Result;
use tofsim_captures::wave::{Excerpt, convert};

use super::super::terminal::Console;
use super::excerpt::{InputArgs, RangeArgs, SignalArgs};

/// Convert a waveform to VCD, FST, CSV or WaveJSON
///
/// The ending of the output decides: .vcd, .fst, .csv, or .json for WaveJSON (WaveDrom), which has 4096 instants at
/// most. CSV and WaveJSON have a row or a column for each instant with a change, and each signal once, by its first
/// name. Levels become 0, 1, x or z, as `compare` reads them: L and H are 0 and 1; U, W and - are x.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim wave convert ghdl.ghw -o ghdl.vcd\n  \
    tofsim wave convert waves/run.vcd -o run.fst")]
pub(super) struct Args {
    #[command(flatten)]
    input: InputArgs,
    /// File to write; its ending decides the format
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Write a part of a waveform: a range of time, some signals
///
/// Times remain as they are. The part begins with the values that the signals have at its start. The ending of the
/// output decides its format, as with `wave convert`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim wave cut run.fst -o part.fst --after 10us --until 12us\n  \
    tofsim wave cut run.vcd -o tdc.vcd --signals '*.tdc.*'")]
pub(super) struct CutArgs {
    #[command(flatten)]
    input: InputArgs,
    /// File to write; its ending decides the format
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    range: RangeArgs,
    #[command(flatten)]
    signals: SignalArgs,
}

/// Converts a whole waveform.
pub(super) fn run(args: &Args, console: &Console) -> Result<()> {
    convert(&args.input.open(console)?, &Excerpt::default(), &args.output)?;
    console.wrote(&args.output);
    Ok(())
}

/// Writes a part of a waveform.
pub(super) fn cut(args: &CutArgs, console: &Console) -> Result<()> {
    convert(&args.input.open(console)?, &args.signals.excerpt(&args.range), &args.output)?;
    console.wrote(&args.output);
    Ok(())
}
