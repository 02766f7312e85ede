//! `tofsim scenario`: what scenarios there are and what is in them.

use clap::Subcommand;
use serde_json::json;

use tofsim::error::{Input, Result};
use tofsim::scenario::{builtin, keys, show};
use tofsim::sim::setup::array::ArraySetup;

use crate::report::writer::print_list;

use super::options::ScenarioArgs;
use super::terminal::{Console, print, print_json};

/// List, show and check scenarios
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// List the built-in scenarios
    List {
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Print a scenario in full, every key with its meaning, unit, range and source
    Show {
        #[command(flatten)]
        which: ScenarioArgs,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Check a scenario and the files that it names
    Check {
        #[command(flatten)]
        which: ScenarioArgs,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Print the JSON Schema of scenario files
    Schema,
}

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    match &args.what {
        What::List { json } => list(*json),
        What::Show { which, json } => {
            let loaded = which.load(None)?;
            if *json {
                print(&format!("{:#}\n", json!(loaded.scenario)))
            } else {
                print(&show::show(&loaded.scenario))
            }
        }
        What::Check { which, json } => {
            let array = ArraySetup::new(which.load(None)?)?;
            let setup = array.common();
            setup.windows(&[], 1)?;
            let notes = array.notes()?;
            console.print_notes(&notes)?;
            if *json {
                print_json(&json!({ "scenario": setup.name, "ok": true, "notes": notes }))
            } else {
                console.report(&format!("{}: ok\n", setup.name))
            }
        }
        What::Schema => print(&format!("{:#}\n", keys::schema())),
    }
}

/// What a list says of a scenario; all else in it is passed over.
#[derive(serde::Deserialize)]
struct Described {
    description: String,
}

fn list(as_json: bool) -> Result<()> {
    let row = |(name, text): (&'static str, &str)| {
        let Described { description } = toml::from_str(text)
            .map_err(|error| Input::new(name, "expected a description").value(error.message()))?;
        Ok([name.to_owned(), description])
    };
    let rows = builtin::scenarios().map(row).collect::<Result<Vec<_>>>()?;
    print_list(["name", "description"], &rows, as_json)
}
