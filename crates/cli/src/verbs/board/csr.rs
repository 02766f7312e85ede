//! `tofsim board csr`: the register map for LiteX's tools.

use std::path::PathBuf;

use tofsim::error::Result;
use tofsim::files::output::write_bytes;
use tofsim::sim::setup::Setup;
use tofsim_board::csr::csr_csv;

use crate::verbs::options::ScenarioArgs;
use crate::verbs::terminal::{Console, print};

/// Print the register map as csr.csv, which LiteX's RemoteClient and litex_cli read
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim board csr -o csr.csv\n  \
    litex_server --uart --uart-port PORT --uart-baudrate 921600\n  \
    litex_cli --csr-csv csr.csv --regs")]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Write the file here instead of to standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let text = csr_csv(&Setup::of_counts(args.scenario.load(None)?)?);
    let Some(path) = &args.output else { return print(&text) };
    write_bytes(path, text)?;
    console.wrote(path);
    Ok(())
}
