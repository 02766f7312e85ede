//! `tofsim sweep merge`: one table of those of a sweep's shards.

use std::path::PathBuf;

use serde_json::json;

use tofsim::error::{Input, Result};
use tofsim::files::output::create_directory;
use tofsim_studies::merge::{Shards, files};
use tofsim_studies::sweep::ABOUT;

use crate::record::Record;
use crate::verbs::terminal::{Talk, print_json};

/// Make one table of the shards of a sweep, when all are there
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The tables of the shards, or folders that have them
    #[arg(required = true, value_name = "FILE|DIR")]
    shards: Vec<PathBuf>,
    /// Write sweep.parquet and sweep.csv there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print one JSON object instead of nothing
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    let files = files(&args.shards)?;
    let shards = Shards::open(&files)?;
    let record = record_of(&shards.about)?;
    create_directory(&args.output)?;
    let written = shards.write(&args.output, &record.comment_line())?;
    written.iter().for_each(|path| talk.wrote(path));
    if args.json {
        let names = |paths: &[PathBuf]| {
            paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>()
        };
        let object = json!({
            "schema": "tofsim.sweep-merge/1",
            "shards": names(&files),
            "files": names(&written),
            "set": record.set,
            "hash": record.hash,
            "notes": [],
        });
        print_json(&object)?;
    }
    Ok(())
}

/// Returns the record in the description of a sweep's table.
fn record_of(about: &str) -> Result<Record> {
    let record = Record::find(about.as_bytes());
    record.ok_or_else(|| Input::new(ABOUT, "expected what a sweep says of itself").into())
}
