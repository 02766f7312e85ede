//! `tofsim ila`: the logic analyser.

pub mod capture;
pub mod info;

use clap::Subcommand;

use crate::error::Result;

use super::talk::Talk;

/// The logic analyser: capture a simulation as Vivado's captures the board, and read its files
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Capture(Box<capture::Args>),
    Info(info::Args),
}

/// Runs the command.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    match &args.verb {
        Verb::Capture(args) => capture::run(args, talk),
        Verb::Info(args) => info::run(args),
    }
}
