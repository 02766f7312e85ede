//! `tofsim budget`: the link budget of a scenario, what a shot can expect, and the laser's class.

mod findings;
mod table;

use tofsim::Setup;
use tofsim::error::Result;
use tofsim::scenario;

use crate::record::Record;

use super::terminal::{Talk, print_json};
use findings::Findings;

/// Print the link budget: photons and avalanches that a shot can expect, and eye safety
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in scenario, or the path of a scenario file (see `scenario list`)
    #[arg(default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a key of the scenario, such as target.distance_m=0.3; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    let setup = Setup::of_counts(scenario::load(&args.scenario, &args.set)?)?;
    let findings = Findings::of(setup);
    let notes = findings.notes();
    match args.json {
        true => {
            let mut object = findings.json();
            Record::new(&findings.setup, &talk.command).put_into(&mut object, &notes);
            print_json(&object)?;
        }
        false => talk.report(&format!("{}\n", table::table(&findings)))?,
    }
    talk.heed(&notes)
}
