//! `tofsim ila tcl`: an ILA core with a configuration's probes, for Vivado.

use std::path::PathBuf;

use tofsim::error::Result;
use tofsim::files::output::write_bytes;
use tofsim_captures::ila::debug_core::tcl;
use tofsim_captures::ila::{AnalyserPlan, AnalyserSetup};

use crate::record::Record;
use crate::verbs::terminal::{Console, print};

use super::capture::simulated;

/// Print Tcl with which Vivado inserts an ILA core with these probes into the board's design
///
/// rtl_ref/kc705.tcl takes the file as its second argument. Nets have the names of rtl_ref below tof_top. The trigger is
/// set in Vivado's hardware manager. No Vivado has run the file yet.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim ila tcl --probes shot -o ila.tcl\n  \
    vivado -mode batch -source rtl_ref/kc705.tcl -tclargs vivado ila.tcl")]
pub struct Args {
    /// Built-in scenario or the path of a scenario file [default: that of the probe configuration]
    scenario: Option<String>,
    /// Built-in probe configuration, or the path of a file
    #[arg(long, value_name = "NAME|FILE")]
    probes: String,
    /// Set a scenario key, e.g. `estimator.kind=likelihood`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Write the file here instead of to standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let set_up = AnalyserSetup::load(&args.probes)?;
    let setup = simulated(&set_up, args.scenario.as_deref(), &args.set, None)?.setup;
    let plan = AnalyserPlan::new(&set_up, &setup)?;
    let text = tcl(&set_up, &plan, &setup)?;
    let text = Record::new(&setup, &console.command).comment_line() + &text;
    let Some(path) = &args.output else { return print(&text) };
    write_bytes(path, text)?;
    console.wrote(path);
    Ok(())
}
