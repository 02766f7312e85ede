//! `tofsim wave`: waveform files of any design.

mod convert;
mod excerpt;
mod info;
mod stats;

use std::process::ExitCode;

use clap::Subcommand;

use tofsim::error::Result;

use super::compare;
use super::deferred::Deferred;
use super::terminal::Console;

/// Inspect, compare, cut and convert waveform files
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    verb: Deferred<Verb>,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Info(info::Args),
    Stats(stats::Args),
    Diff(Box<compare::Args>),
    Cut(convert::CutArgs),
    Convert(convert::Args),
}

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<ExitCode> {
    match &args.verb.0 {
        Verb::Info(args) => info::run(args, console),
        Verb::Stats(args) => stats::run(args, console),
        Verb::Diff(args) => return compare::run(args, console),
        Verb::Cut(args) => convert::cut(args, console),
        Verb::Convert(args) => convert::run(args, console),
    }?;
    Ok(ExitCode::SUCCESS)
}
