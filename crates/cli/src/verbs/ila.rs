//! `tofsim ila`: the logic analyser.

pub mod capture;
pub mod info;
pub mod replay;
pub mod tcl;

use clap::Subcommand;
use schemars::schema_for;

use tofsim::error::Result;
use tofsim_captures::compare::SignalMap;
use tofsim_captures::ila::setup::AnalyserSetupFile;
use tofsim_captures::ila::{AnalyserSetup, builtin};

use crate::report::writer::print_list;
use crate::verbs::terminal::print;

use super::deferred::Deferred;
use super::terminal::Console;

/// The logic analyser: capture a simulation as Vivado's captures the board, and read its files
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    verb: Deferred<Verb>,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Capture(Box<capture::Args>),
    Info(info::Args),
    Replay(replay::Args),
    Tcl(tcl::Args),
    /// List the built-in probe configurations
    List {
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Print a probe configuration, as a template for your own
    Show {
        /// Built-in probe configuration, or the path of a file
        set_up: String,
    },
    /// Print the JSON Schema of probe configurations: every key with its meaning and unit
    Schema {
        /// Print the schema of the map files of `compare` instead
        #[arg(long)]
        map: bool,
    },
}

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    match &args.verb.0 {
        Verb::Capture(args) => capture::run(args, console),
        Verb::Info(args) => info::run(args, console),
        Verb::Replay(args) => replay::run(args, console),
        Verb::Tcl(args) => tcl::run(args, console),
        Verb::List { json } => list(*json),
        Verb::Show { set_up } => show(set_up),
        Verb::Schema { map } => schema(*map),
    }
}

/// Prints the built-in set-ups and what they show.
fn list(as_json: bool) -> Result<()> {
    let row = |(name, _): &(&str, _)| {
        let file = AnalyserSetup::load(name)?.file;
        Ok([name.to_string(), file.scenario, file.description])
    };
    let rows = builtin::SET_UPS.iter().map(row).collect::<Result<Vec<_>>>()?;
    print_list(["name", "scenario", "description"], &rows, as_json)
}

/// Prints a set-up as a file to begin one's own with.
fn show(name: &str) -> Result<()> {
    match builtin::set_up(name) {
        Some(text) => print(text),
        None => AnalyserSetup::load(name)
            .and_then(|_| tofsim::error::read_text(std::path::Path::new(name)))
            .and_then(|text| print(&text)),
    }
}

/// Prints the JSON Schema of set-ups, or of maps.
fn schema(of_maps: bool) -> Result<()> {
    let schema = if of_maps { schema_for!(SignalMap) } else { schema_for!(AnalyserSetupFile) };
    print(&format!("{:#}\n", schema.as_value()))
}
