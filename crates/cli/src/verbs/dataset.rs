//! `tofsim dataset`: histograms in bulk, for training and tests.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use serde_json::json;

use tofsim::error::{Error, Result};
use tofsim::scenario;
use tofsim::sim::setup::Setup;
use tofsim_learn::dataset::files::{DatasetFiles, DatasetFormat};
use tofsim_learn::dataset::{DatasetDescription, Grid, HistogramSource, Sample};

use crate::choice::{self, words};
use crate::text::table::{facts, grouped};

use super::draws::Draws;
use super::terminal::{Talk, print_json, stop_signal};

/// Draw histograms of many scenes, for training and tests
#[derive(Debug, clap::Args)]
#[command(after_help = "Scenes are those of the thesis: irradiance 0 to 0.4 W/m^2/nm in 9 steps, \
    reflectance 0.08 to 0.60\nin 53, distance 0.1 to 0.6 m in 201 (train) or 51 (test), each 5 \
    times. All else is the scenario's.\n\nExamples:\n  \
    tofsim dataset -o train                          479,385 histograms as Parquet\n  \
    tofsim dataset --grid test --seed 2 -o test      121,635 of them\n  \
    tofsim dataset --rows 24000 --format npy -o few  random scenes, equally many a distance\n  \
    tofsim dataset --profile my-chain.toml -o own    for a chain that was measured")]
pub struct Args {
    /// Built-in scenario, or the path of a scenario file (see `scenario list`)
    #[arg(default_value = scenario::DEFAULT)]
    scenario: String,
    #[command(flatten)]
    draws: Draws,
    /// Which scenes
    #[arg(long, value_parser = words(choice::GRID), default_value = "train")]
    grid: Grid,
    /// What to write, separated by commas
    #[arg(long, value_parser = words(choice::DATASET_FORMAT), value_delimiter = ',', default_value = "parquet")]
    format: Vec<DatasetFormat>,
    /// Write the files and dataset.json, their description, there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    let loaded = args.draws.load(&args.scenario)?;
    let (name, seed) = (loaded.name.clone(), loaded.scenario.seed);
    let source = HistogramSource::new(&Setup::new(loaded)?)?;
    let rows = args.draws.rows(None, args.grid, seed);
    let description = DatasetDescription::new(&name, &args.draws.set, &source, &rows, seed);
    let files = DatasetFiles::create(&args.output, &args.format, &description)?;
    let stop = stop_signal();
    let blocks = source.blocks(&rows, seed);
    let written = args
        .draws
        .on_threads(rows.count(), talk, |done| write(files, blocks, stop.as_deref(), done))?;
    written.iter().for_each(|path| talk.wrote(path));

    let files: Vec<_> = written.iter().map(|path| path.display().to_string()).collect();
    if args.json {
        let mut report = json!(description);
        report["files"] = json!(files);
        return print_json(&report);
    }
    talk.report(&table(&description, &files))
}

/// Writes a block while the next one is drawn.
fn write(
    mut files: DatasetFiles,
    mut blocks: impl Iterator<Item = Vec<Sample>> + Send,
    stop: Option<&AtomicBool>,
    done: &dyn Fn(u64),
) -> Result<Vec<PathBuf>> {
    let mut next = blocks.next();
    while let Some(block) = next {
        if stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
            return Err(Error::Interrupted);
        }
        let (written, drawn) = rayon::join(|| files.write(&block), || blocks.next());
        written?;
        done(block.len() as u64);
        next = drawn;
    }
    files.finish()
}

fn table(description: &DatasetDescription, files: &[String]) -> String {
    let choice = if description.subset { "random scenes of " } else { "" };
    let shots = grouped(description.shots_per_frame.into());
    let rows = [
        ("scenario", description.scenario.clone()),
        ("chain", description.profile.clone()),
        ("grid", format!("{choice}{}", description.grid)),
        ("histograms", grouped(description.rows)),
        ("shots", format!("{shots} each")),
        ("seed", description.seed.to_string()),
    ];
    let files = files.iter().map(|file| ("file", file.clone()));
    format!("{}\n", facts(rows.into_iter().chain(files)))
}
