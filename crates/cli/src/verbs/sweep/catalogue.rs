//! `tofsim sweep list`, `show` and `columns`: plans that come with the program, and columns of a table; `tofsim sweep merge`:
//! one table of those of a sweep's shards.

use std::path::PathBuf;

use serde_json::json;

use tofsim::error::{Input, Result, hint};
use tofsim::files::output::create_directory;
use tofsim_learn::estimation::EstimatorKind;
use tofsim_studies::columns::Column;
use tofsim_studies::merge::{Shards, files};
use tofsim_studies::plan::builtin::{PLANS, plan};
use tofsim_studies::plan::file::Fidelity;
use tofsim_studies::sweep::ABOUT;
use tofsim_studies::{Plan, columns};

use crate::choice::words;
use crate::record::Record;
use crate::report::writer::objects;
use crate::text::table::{plain, table};
use crate::verbs::terminal::{Console, print, print_json};

/// List the built-in plans
#[derive(Debug, clap::Args)]
pub struct ListArgs {
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Print a built-in plan
#[derive(Debug, clap::Args)]
pub struct ShowArgs {
    /// Its name
    plan: String,
}

/// List the available columns
#[derive(Debug, clap::Args)]
pub struct ColumnsArgs {
    /// Estimators whose columns to list
    #[arg(long, value_parser = words(EstimatorKind::ALL), value_delimiter = ',', default_value = "network")]
    estimator: Vec<EstimatorKind>,
    /// List the columns of the images of an array instead
    #[arg(long, conflicts_with = "estimator")]
    array: bool,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Lists the plans.
pub fn list(args: &ListArgs, console: &Console) -> Result<()> {
    let described = |(name, _): &(&str, &str)| {
        Ok([(*name).to_owned(), Plan::load(name, &[], None)?.file.description])
    };
    let plans = PLANS.iter().map(described).collect::<Result<Vec<_>>>()?;
    if args.json {
        let plans = objects(["name", "description"], &plans);
        return print_json(&json!({ "schema": "tofsim.sweep-list/1", "plans": plans }));
    }
    console.report(&(plain(plans) + "\n"))
}

/// Prints a plan.
pub fn show(args: &ShowArgs) -> Result<()> {
    match plan(&args.plan) {
        Some((_, text)) => print(text),
        None => {
            let (hint, known) = hint(&args.plan, PLANS.iter().map(|(name, _)| *name));
            let expected = format!("no built-in plan{hint}; expected one of {known}");
            Err(Input::new("plan", expected).value(&args.plan).into())
        }
    }
}

/// Lists the columns.
pub fn columns(args: &ColumnsArgs, console: &Console) -> Result<()> {
    let columns = match args.array {
        true => columns::of_images(),
        false => columns::all(Fidelity::Histogram, &args.estimator),
    };
    if args.json {
        return print_json(&json!({ "schema": "tofsim.sweep-columns/1", "columns": columns }));
    }
    let row =
        |column: &Column| [column.name.clone(), column.unit.to_owned(), column.meaning.to_owned()];
    console.report(&(table(["column", "unit", "meaning"], columns.iter().map(row), 9..) + "\n"))
}

/// Merge the shards of a sweep into one table
#[derive(Debug, clap::Args)]
pub struct MergeArgs {
    /// Tables of the shards, or folders that contain them
    #[arg(required = true, value_name = "FILE|DIR")]
    shards: Vec<PathBuf>,
    /// Write sweep.parquet and sweep.csv into this folder
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print one JSON object instead of nothing
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub fn merge(args: &MergeArgs, console: &Console) -> Result<()> {
    let files = files(&args.shards)?;
    let shards = Shards::open(&files)?;
    let record = record_of(&shards.about)?;
    create_directory(&args.output)?;
    let written = shards.write(&args.output, &record.comment_line())?;
    written.iter().for_each(|path| console.wrote(path));
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
