//! `tofsim new`: a scenario to begin with.

use std::path::PathBuf;

use tofsim::error::{Input, Result};
use tofsim::files::output::write_bytes;
use tofsim::scenario::{self, show};

use super::terminal::Console;

/// Write a starter scenario: the twenty keys that are changed most often, with comments
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tofsim new mine.toml\n  tofsim run mine.toml")]
pub struct Args {
    /// Scenario file to write
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Replace an existing file
    #[arg(long)]
    force: bool,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    if args.file.exists() && !args.force {
        let expected = "exists already; expected the name of a new file, or --force";
        return Err(Input::new(args.file.display(), expected).into());
    }
    let scenario = scenario::load(scenario::DEFAULT, &[])?.scenario;
    let head = "# A scenario of tofsim. Keys that are not here have their defaults: `tofsim scenario show` lists all, with\n\
        # unit, range and source. `tofsim scenario check FILE` checks it, `tofsim run FILE` simulates it.\n\n";
    write_bytes(&args.file, head.to_owned() + &show::starter(&scenario))?;
    console.wrote(&args.file);
    Ok(())
}
