//! `tofsim budget`: the link budget of a scenario, what a shot can expect, and the laser's class; or which effect
//! makes its depth wrong by how much.

mod errors;
pub mod findings;
pub mod table;

use tofsim::Setup;
use tofsim::error::Result;

use crate::record::Record;

use super::options::ScenarioArgs;
use super::terminal::{Talk, print_json};
use errors::ErrorArgs;
use findings::Findings;

/// Print the link budget: photons and avalanches that a shot can expect, and eye safety
///
/// With --errors it is the error budget of the depth: what shot noise, pile-up, ambient light, pulse, jitter, the
/// TDC's taps and their calibration, and the estimator's words do to bias and spread.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim budget near\n  \
    tofsim budget --errors -s tdc.profile=kintex7\n  \
    tofsim budget --errors --estimator likelihood --grid target.distance_m=0.1..0.6:0.1 -o out")]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    errors: ErrorArgs,
}

/// Runs the command.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    if args.errors.errors {
        return args.errors.run(&args.scenario, args.json, talk);
    }
    let setup = Setup::of_counts(args.scenario.load(None)?)?;
    let findings = Findings::of(setup);
    let notes = findings.notes()?;
    if args.json {
        let mut object = findings.json();
        Record::new(&findings.setup, &talk.command).put_into(&mut object, &notes);
        print_json(&object)?;
    } else {
        talk.report(&format!("{}\n", table::table(&findings)))?
    }
    talk.heed(&notes)
}
