//! `tofsim sweep`: a scenario at many points.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use tofsim::Note;
use tofsim::error::{Input, Result};
use tofsim::files::digest::digest;
use tofsim::files::folder::FolderLock;
use tofsim::files::output::write_bytes;
use tofsim_studies::sweep::Finished;
use tofsim_studies::table::Row;
use tofsim_studies::table::reader::TableReader;
use tofsim_studies::{Plan, Shard, Sweep};

use crate::choice::{seed, threads};
use crate::record::Record;
use crate::report::{sweep as report, sweep_plot};

use super::draws::use_threads;
use super::terminal::{Console, print_json, stop_signal};

mod catalogue;

/// Evaluate a scenario over a parameter grid, or search for the value that just meets a limit
#[derive(Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(
    after_help = "A plan is a TOML file with axes (lists, ranges, distributions) over any keys of the \
    scenario, the simulation at each point, the columns of the table, and the search, if any; see \
    docs/studies.md. A sweep that was stopped or killed is resumed.\n\nExamples:\n  \
    tofsim sweep fig-4-2                    a built-in plan, table printed\n  \
    tofsim sweep p.toml -o out              Parquet and CSV; SVG with [plot]\n  \
    tofsim sweep p.toml --shard 3/7 -o out  one of seven parts, for job arrays\n  \
    tofsim sweep merge out -o whole         one table of all seven\n  \
    tofsim sweep list                       built-in plans\n  \
    tofsim sweep columns                    available columns"
)]
pub struct Args {
    #[command(subcommand)]
    action: Option<Action>,
    #[command(flatten)]
    sweep: SweepArgs,
}

#[derive(Debug, clap::Subcommand)]
enum Action {
    Merge(catalogue::MergeArgs),
    List(catalogue::ListArgs),
    Show(catalogue::ShowArgs),
    Columns(catalogue::ColumnsArgs),
}

#[derive(Debug, clap::Args)]
struct SweepArgs {
    /// Built-in plan, or the path of a plan file (see `sweep list`)
    #[arg(required = true)]
    plan: Option<String>,
    /// Set a key of the scenario at all points, such as spad.pdp=0.02; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Seed of every random number, instead of the plan's
    #[arg(long, value_name = "N", value_parser = seed())]
    seed: Option<u64>,
    /// Evaluate one of N parts, every Nth point from the Ith on
    #[arg(long, value_name = "I/N", requires = "output")]
    shard: Option<Shard>,
    /// Discard the results in the folder and start again
    #[arg(long, requires = "output")]
    restart: bool,
    /// Threads; the results are the same for any number [default: one a core]
    #[arg(long, value_name = "N", value_parser = threads())]
    threads: Option<u16>,
    /// Write the table into this folder, as Parquet and CSV, and the plot of the plan
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    match &args.action {
        Some(Action::Merge(args)) => catalogue::merge(args, console),
        Some(Action::List(args)) => catalogue::list(args, console),
        Some(Action::Show(args)) => catalogue::show(args),
        Some(Action::Columns(args)) => catalogue::columns(args, console),
        None => args.sweep.run(console),
    }
}

impl SweepArgs {
    fn run(&self, console: &Console) -> Result<()> {
        let Some(name) = &self.plan else {
            return Err(Input::new("plan", "expected a built-in plan or the path of one").into());
        };
        let plan = Plan::load(name, &self.set, self.seed)?;
        let setup = plan.setup()?;
        let record = Record::new(&setup, &console.command);
        let about = about(&plan, &record);
        let sweep = Sweep {
            plan: &plan,
            shard: self.shard.unwrap_or(Shard::WHOLE),
            about: about.to_string(),
            comment: record.comment_line(),
        };
        use_threads(self.threads)?;
        let mut finished = self.finished(&sweep, console)?;
        let notes = notes(&finished, sweep.shard.size(plan.points.count()));
        if let (Some(folder), Shard::WHOLE) = (&self.output, sweep.shard) {
            match draw(&plan, &record, &finished.rows, folder)? {
                Some(Ok(path)) => finished.files.push(path),
                // The table is there all the same.
                Some(Err(fault)) => console.note(fault),
                None => {}
            }
        }
        finished.files.iter().for_each(|path| console.wrote(path));
        console.print_notes(&notes)?;
        if self.json {
            return print_json(&self.object(about, &plan, &finished, &notes));
        }
        let shown = plan.points.count();
        console.report(&report::text(&plan, &finished.rows, shown))
    }

    fn finished(&self, sweep: &Sweep, console: &Console) -> Result<Finished> {
        let stop = stop_signal();
        let count = sweep.shard.size(sweep.plan.points.count());
        let Some(folder) = &self.output else {
            let progress = console.progress(count, "points");
            let finished = sweep.in_memory(stop.as_deref(), &|more| progress.inc(more));
            progress.finish_and_clear();
            return finished;
        };
        let _held = FolderLock::share(folder)?;
        if !self.restart && sweep.is_done(folder) {
            console.note(format_args!("{} is there and whole", sweep.table(folder).display()));
            return read(sweep, folder);
        }
        let progress = console.progress(count, "points");
        let is_first = std::sync::atomic::AtomicBool::new(true);
        let done = |more| {
            progress.inc(more);
            // Those that were there took no time.
            if is_first.swap(false, std::sync::atomic::Ordering::Relaxed) {
                progress.reset_eta();
            }
        };
        let finished = sweep.run(folder, self.restart, stop.as_deref(), &done);
        progress.finish_and_clear();
        if let Err(tofsim::Error::Interrupted) = &finished {
            console.note(format_args!(
                "finished points are kept in {}; the same command goes on",
                folder.display()
            ));
        }
        let finished = finished?;
        if finished.resumed > 0 {
            console.note(format_args!("{} of {count} points were there already", finished.resumed));
        }
        Ok(finished)
    }

    fn object(&self, mut about: Value, plan: &Plan, finished: &Finished, notes: &[Note]) -> Value {
        let files: Vec<_> = finished.files.iter().map(|path| path.display().to_string()).collect();
        about["shard"] = json!(self.shard.map(|shard| shard.to_string()));
        about["files"] = json!(files);
        if self.output.is_none() {
            let names: Vec<_> = tofsim_studies::header::header(plan);
            let object = |row: &Row| -> Value {
                let pairs = names.iter().zip(&row.cells);
                pairs
                    .map(|(field, cell)| (field.name.clone(), json!(cell)))
                    .collect::<serde_json::Map<_, _>>()
                    .into()
            };
            about["rows"] = finished.rows.iter().map(object).collect();
        }
        about["notes"] = json!(notes);
        about
    }
}

/// The rows of a sweep whose table is there.
fn read(sweep: &Sweep, folder: &Path) -> Result<Finished> {
    let path = sweep.table(folder);
    let mut table = TableReader::open(&path)?;
    let mut finished = Finished { resumed: table.count, ..Finished::default() };
    while let Some(row) = table.next_row()? {
        if finished.rows.len() < tofsim_studies::sweep::SHOWN {
            finished.rows.push(row);
        }
    }
    finished.files.push(path);
    Ok(finished)
}

/// Returns the description that a table carries, the same for all shards.
pub fn about(plan: &Plan, record: &Record) -> Value {
    let mut about = json!({
        "schema": "tofsim.sweep/1",
        "plan": plan.name,
        "plan_text": plan.text,
        "plan_digest": format!("{:016x}", digest(0, plan.text.as_bytes())),
        "points": plan.points.count(),
        "columns": plan.outputs,
    });
    if let (Some(object), Value::Object(own)) = (about.as_object_mut(), json!(record)) {
        object.extend(own);
        object.insert("seed".to_owned(), json!(plan.seed));
    }
    about
}

/// Draws the picture of a plan that has one, beside its table; its path, or why its rows cannot be drawn.
///
/// # Errors
/// When the file cannot be written.
pub fn draw(
    plan: &Plan,
    record: &Record,
    rows: &[Row],
    folder: &Path,
) -> Result<Option<std::result::Result<PathBuf, String>>> {
    let Some(plot) = &plan.file.plot else { return Ok(None) };
    let path = folder.join("sweep.svg");
    match sweep_plot::svg(plot, &tofsim_studies::header::header(plan), rows) {
        Ok(svg) => {
            write_bytes(&path, record.in_svg(&svg))?;
            Ok(Some(Ok(path)))
        }
        Err(fault) => Ok(Some(Err(format!("no sweep.svg: {fault}")))),
    }
}

/// Returns the notes on the values, each cause once.
pub fn notes(finished: &Finished, points: u64) -> Vec<Note> {
    let counted = |(note, count): &(Note, u64)| {
        let text = match points {
            1 => note.text.clone(),
            _ => format!("{}, and so at {count} of {points} points", note.text),
        };
        Note { text, ..note.clone() }
    };
    finished.notes.iter().map(counted).collect()
}
