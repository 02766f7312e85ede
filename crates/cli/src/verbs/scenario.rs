//! `tofsim scenario`: what scenarios there are and what is in them.

use clap::Subcommand;
use serde_json::json;

use tofsim::error::Result;
use tofsim::scenario::{self, builtin, show};
use tofsim::sim::setup::Setup;

use crate::text::table::facts;

use super::terminal::{Talk, print, print_json};

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
        which: Which,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Check a scenario and the files that it names
    Check {
        #[command(flatten)]
        which: Which,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Print the JSON Schema of scenario files
    Schema,
}

#[derive(Debug, clap::Args)]
struct Which {
    /// Built-in scenario, or the path of a scenario file
    #[arg(default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a key of the scenario, such as target.distance_m=0.3; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// Runs the command.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    match &args.what {
        What::List { json } => list(*json),
        What::Show { which, json } => {
            let loaded = scenario::load(&which.scenario, &which.set)?;
            match json {
                true => print(&format!("{:#}\n", json!(loaded.scenario))),
                false => print(&show::show(&loaded.scenario)),
            }
        }
        What::Check { which, json } => {
            let setup = Setup::new(scenario::load(&which.scenario, &which.set)?)?;
            setup.windows(&[], 1)?;
            let notes = setup.notes()?;
            talk.heed(&notes)?;
            match json {
                true => print_json(&json!({ "scenario": setup.name, "ok": true, "notes": notes })),
                false => talk.report(&format!("{}: ok\n", setup.name)),
            }
        }
        What::Schema => print(&format!("{:#}\n", show::schema())),
    }
}

fn list(as_json: bool) -> Result<()> {
    let mut rows = Vec::new();
    for (name, _) in builtin::scenarios() {
        rows.push((name, scenario::load(name, &[])?.scenario.description));
    }
    if as_json {
        let object = |(name, description): &(&str, String)| json!({ "name": name, "description": description });
        return print_json(&rows.iter().map(object).collect());
    }
    print(&format!("{}\n", facts(rows)))
}
