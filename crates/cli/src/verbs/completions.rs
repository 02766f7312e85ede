//! `tofsim completions`: what a shell needs to complete our command lines.

use clap::CommandFactory;
use clap_complete::{Shell, generate};

use tofsim::error::Result;

use super::stdout::print;

/// Print a completion script for a shell
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let mut script = Vec::new();
    generate(args.shell, &mut super::Cli::command(), "tofsim", &mut script);
    print(&String::from_utf8_lossy(&script))
}
