//! `tofsim completions`: what a shell needs to complete our command lines.

use clap::Command;
use clap_complete::{Shell, generate};

use tofsim::error::Result;

use super::terminal::print;

/// Print a completion script for a shell
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Prints the script for the whole of `command`.
pub fn run(args: &Args, command: &mut Command) -> Result<()> {
    let mut script = Vec::new();
    generate(args.shell, command, "tofsim", &mut script);
    print(&String::from_utf8_lossy(&script))
}
