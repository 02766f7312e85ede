//! `tofsim board`: a real board, through its registers.

mod calibrate;
mod connection;
mod csr;
mod info;
mod run;
mod set;
mod watch;

use std::process::ExitCode;

use clap::Subcommand;

use tofsim::error::Result;

use super::deferred::Deferred;
use super::terminal::Console;

/// Operate a real board over its serial port: depths, histograms, calibration, registers
///
/// The board must have been built with the parameters of the scenario; its hash of them is compared. The laser stays off
/// unless --laser is given, and is switched off at the end, on Ctrl-C, and by the firmware itself when the host is silent.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim board info --port /dev/ttyUSB0\n  \
    tofsim board run --frames 20 --laser --port /dev/ttyUSB0 -o out --csv\n  \
    tofsim board set laser_freq=2 --port /dev/ttyUSB0\n  \
    tofsim board calibrate --port /dev/ttyUSB0 -o cal\n  \
    tofsim board csr -o csr.csv              registers for LiteX's tools")]
pub struct Args {
    #[command(subcommand)]
    verb: Deferred<Verb>,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Info(info::Args),
    Run(run::Args),
    Set(set::Args),
    Calibrate(calibrate::Args),
    Watch(watch::Args),
    Csr(csr::Args),
}

/// Runs the verb; the status says whether the board has the scenario's parameters.
pub fn run(args: &Args, console: &Console) -> Result<ExitCode> {
    match &args.verb.0 {
        Verb::Info(args) => return info::run(args, console),
        Verb::Run(args) => run::run(args, console),
        Verb::Set(args) => set::run(args, console),
        Verb::Calibrate(args) => calibrate::run(args, console),
        Verb::Watch(args) => watch::run(args, console),
        Verb::Csr(args) => csr::run(args, console),
    }?;
    Ok(ExitCode::SUCCESS)
}
