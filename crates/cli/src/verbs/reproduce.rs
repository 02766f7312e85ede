//! `tofsim reproduce`: the tables and figures of the thesis, beside what comes out here.

use std::path::{Path, PathBuf};

use tofsim::error::{Input, Result, nearest};
use tofsim::files::folder::FolderLock;
use tofsim::files::output::write_bytes;
use tofsim::files::staged::StagedFolder;
use tofsim_studies::plan::builtin::is_name;

use crate::choice::{seed, threads};
use crate::page::trace::wavejson;
use crate::record::Record;
use crate::report::writer::print_list;
use crate::reproduce::finding::Finding;
use crate::reproduce::study::Study;
use crate::reproduce::table::{self, Item};
use crate::reproduce::{finding, html, text};

use super::draws::use_threads;
use super::interrupt::look_no_more;
use super::terminal::{Console, print_json, stop_signal};

/// Reproduce the tables and figures of the thesis, each with a verdict
///
/// Verdicts are same, differs, undecided (only with --quick), cannot be reproduced, and nothing to reproduce. Each number
/// is compared with that of the thesis, with its standard error, and each difference has a reason. With ITEMs, only
/// those are reproduced, and their rows are printed.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim reproduce -o thesis\n  \
    tofsim reproduce --quick -o thesis   a tenth of the histograms\n  \
    tofsim reproduce table-4.3 table-6.3\n  \
    tofsim reproduce --list\n\n\
    Exit status: 0 whatever the verdicts, 2 usage or input error.")]
pub struct Args {
    /// Tables, figures and others by name, such as table-4.3 or fig-6.21 [default: all]
    #[arg(value_name = "ITEM")]
    items: Vec<String>,
    /// Write reproduce.html, reproduce.json, and timing diagrams as WaveJSON into this folder
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Use a tenth of the histograms
    #[arg(long)]
    quick: bool,
    /// Print the names of the items and exit
    #[arg(long)]
    list: bool,
    /// Seed of every random stream
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = seed())]
    seed: u64,
    /// Threads; the results are the same for any number [default: one a core]
    #[arg(long, value_name = "N", value_parser = threads())]
    threads: Option<u16>,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let items = chosen(&args.items)?;
    if args.list {
        let rows: Vec<_> = items.into_iter().map(|item| [item.id, item.title]).collect();
        return print_list(["id", "title"], &rows, args.json);
    }
    use_threads(args.threads)?;
    let _held = args.output.as_deref().map(FolderLock::take).transpose()?;
    let study = Study::new(args.seed, args.quick, stop_signal());
    let progress = console.uneven_progress(items.len() as u64, "items");
    let mut made = Vec::new();
    for item in items {
        console.detail(&item.id);
        made.push(Finding::new(&item, &study)?);
        progress.inc(1);
    }
    progress.finish_and_clear();
    look_no_more();
    let setup = study.ideal()?;
    let record = Record::new(&setup, &console.command);
    let mut object = finding::json(&made, args.quick);
    record.put_into(&mut object, &setup.notes()?);
    if let Some(folder) = &args.output {
        let stage = StagedFolder::new(folder)?;
        let object = format!("{object:#}\n");
        write_bytes(&stage.path().join("reproduce.html"), html::page(&made, &record, args.quick))?;
        write_bytes(&stage.path().join("reproduce.json"), object)?;
        write_waves(&made, stage.path())?;
        stage.commit()?.iter().for_each(|path| console.wrote(path));
    }
    match (args.json, args.items.is_empty() && !console.verbose) {
        (true, _) => print_json(&object),
        (false, true) => console.report(&text::overview(&made)),
        (false, false) => console.report(&text::in_full(&made)),
    }
}

/// The timing diagrams of all items.
fn write_waves(findings: &[Finding], folder: &Path) -> Result<()> {
    for one in findings {
        for (words, trace) in &one.traces {
            let path = folder.join(format!("{}.wave.json", one.id));
            write_bytes(&path, format!("{}\n", wavejson(trace, words)))?;
        }
    }
    Ok(())
}

/// Returns the items with some names, or all without names, in the order of the thesis.
fn chosen(names: &[String]) -> Result<Vec<Item>> {
    let all = table::items()?;
    for name in names {
        if !all.iter().any(|item| is_name(name, &item.id)) {
            let near = nearest(name, all.iter().map(|item| item.id.as_str()));
            let hint = near.map_or(String::new(), |near| format!(" (`{near}`?)"));
            let expected = format!("no such item{hint}; see `reproduce --list`");
            return Err(Input::new("ITEM", expected).value(name).into());
        }
    }
    let is_chosen = |item: &Item| names.iter().any(|name| is_name(name, &item.id));
    Ok(all.into_iter().filter(|item| names.is_empty() || is_chosen(item)).collect())
}
