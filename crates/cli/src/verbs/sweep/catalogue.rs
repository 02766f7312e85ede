//! Plans that come with the program, and columns of a sweep.

use serde_json::json;

use tofsim::error::{Input, Result, hint};
use tofsim_learn::estimation::EstimatorKind;
use tofsim_studies::columns;
use tofsim_studies::plan::builtin::{PLANS, plan};
use tofsim_studies::plan::file::Fidelity;
use tofsim_studies::{Plan, columns::Column};

use crate::choice::words;
use crate::text::table::{facts, table};
use crate::verbs::terminal::{Talk, print, print_json};

/// List the plans that come with the program
#[derive(Debug, clap::Args)]
pub struct ListArgs {
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Print a plan that comes with the program
#[derive(Debug, clap::Args)]
pub struct ShowArgs {
    /// Its name
    plan: String,
}

/// List the columns that a table can have
#[derive(Debug, clap::Args)]
pub struct ColumnsArgs {
    /// Estimators whose columns are listed
    #[arg(long, value_parser = words(EstimatorKind::ALL), value_delimiter = ',', default_value = "network")]
    estimator: Vec<EstimatorKind>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Lists the plans.
pub fn list(args: &ListArgs, talk: &Talk) -> Result<()> {
    let described = |(name, _): &(&'static str, &str)| -> Result<(&'static str, String)> {
        Ok((*name, Plan::load(name, &[], None)?.file.description))
    };
    let plans: Vec<_> = PLANS.iter().map(described).collect::<Result<_>>()?;
    if args.json {
        let plan = |(name, description): &(&str, String)| json!({ "name": name, "description": description });
        let plans: Vec<_> = plans.iter().map(plan).collect();
        return print_json(&json!({ "schema": "tofsim.sweep-list/1", "plans": plans }));
    }
    talk.report(&(facts(plans) + "\n"))
}

/// Prints a plan.
pub fn show(args: &ShowArgs) -> Result<()> {
    match plan(&args.plan) {
        Some(text) => print(text),
        None => {
            let (hint, known) = hint(&args.plan, PLANS.iter().map(|(name, _)| *name));
            let expected = format!("no built-in plan{hint}; expected one of {known}");
            Err(Input::new("plan", expected).value(&args.plan).into())
        }
    }
}

/// Lists the columns.
pub fn columns(args: &ColumnsArgs, talk: &Talk) -> Result<()> {
    let columns = columns::all(Fidelity::Histogram, &args.estimator);
    if args.json {
        let column = |column: &Column| json!({ "name": column.name, "unit": column.unit, "meaning": column.meaning });
        let columns: Vec<_> = columns.iter().map(column).collect();
        return print_json(&json!({ "schema": "tofsim.sweep-columns/1", "columns": columns }));
    }
    let row =
        |column: &Column| [column.name.clone(), column.unit.to_owned(), column.meaning.to_owned()];
    talk.report(&(table(["column", "unit", "what it is"], columns.iter().map(row), 9..) + "\n"))
}
