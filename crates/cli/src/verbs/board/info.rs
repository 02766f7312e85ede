//! `tofsim board info`: what a board is, and how it is.

use std::process::ExitCode;

use tofsim::error::Result;
use tofsim::sim::setup::Setup;

use crate::report::board_info::BoardFindings;
use crate::report::writer::Report;
use crate::verbs::options::ScenarioArgs;
use crate::verbs::terminal::Console;

use super::connection::PortArgs;

/// Print what a board is, and its state: version, parameters, clock, counters, status, laser faults
///
/// Exit status 1 means that the board was built with other parameters than those of the scenario.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example:\n  tofsim board info --port /dev/ttyUSB0 -s estimator.kind=likelihood"
)]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    #[command(flatten)]
    port: PortArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the verb; the status says whether the board has the scenario's parameters.
pub fn run(args: &Args, console: &Console) -> Result<ExitCode> {
    let setup = Setup::new(args.scenario.load(None)?)?;
    let mut board = args.port.connect()?;
    let findings = BoardFindings::read(&mut board, &setup)?;
    let matches = findings.matches();
    Report::new(findings, &setup, &[], console).deliver(None, args.json, console)?;
    Ok(if matches { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
