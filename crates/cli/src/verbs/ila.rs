//! `tofsim ila`: the logic analyser.

pub mod capture;
pub mod info;
pub mod replay;
pub mod set_ups;

use clap::Subcommand;

use tofsim::error::Result;

use super::terminal::Talk;

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
    Replay(replay::Args),
    /// List the built-in set-ups of captures
    List {
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Print a set-up, to begin one's own with
    Show {
        /// Built-in set-up, or the path of a set-up file
        set_up: String,
    },
    /// Print the JSON Schema of set-up files: every key with its meaning and unit
    Schema {
        /// That of the map files of `compare`
        #[arg(long)]
        map: bool,
    },
}

/// Runs the command.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    match &args.verb {
        Verb::Capture(args) => capture::run(args, talk),
        Verb::Info(args) => info::run(args, talk),
        Verb::Replay(args) => replay::run(args, talk),
        Verb::List { json } => set_ups::list(*json),
        Verb::Show { set_up } => set_ups::show(set_up),
        Verb::Schema { map } => set_ups::schema(*map),
    }
}
