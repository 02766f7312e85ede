//! `tofsim dataset`: histograms in bulk, for training and tests.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use serde::Serialize;
use serde_json::{Value, json};

use tofsim::Note;
use tofsim::error::{Result, poll_stop};
use tofsim::files::folder::FolderLock;
use tofsim::scenario;
use tofsim_learn::dataset::files::{DatasetFiles, DatasetFormat};
use tofsim_learn::dataset::{Axis, DatasetDescription, Grid, GridPurpose, Sample};

use crate::choice::{self, words};
use crate::report::writer::{Findings, Report};
use crate::text::table::{facts, grouped};

use super::draws::Draws;
use super::scenes::Scenes;
use super::terminal::{Console, stop_signal};

/// Draw histograms of many scenes, for training and tests
#[derive(Debug, clap::Args)]
#[command(
    after_help = "By default, the scenes are those of the thesis: irradiance 0 to 0.4 W/m^2/nm in 9 \
    steps, reflectance 0.08 to 0.60 in 53, distance 0.1 to 0.6 m in 201 (train) or 51 (test), 5 histograms each. --grid \
    KEY=... sets your own scenes; keys without --grid are those of the scenario. An array has a row for each pixel of \
    each scene, by default of its own scene.\n\nExamples:\n  \
    tofsim dataset -o train                          479,385 histograms, Parquet\n  \
    tofsim dataset --grid test --seed 2 -o test      121,635 histograms\n  \
    tofsim dataset --rows 24000 --format npy -o few  random scenes\n  \
    tofsim dataset --profile my-chain.toml -o own    a measured chain\n  \
    tofsim dataset --grid target.distance_m=0.05..0.9:0.05 -o far\n  \
    tofsim dataset array --repeats 100 -o pixels     40 x 30 pixels, 100 each"
)]
pub struct Args {
    /// Built-in scenario, or the path of a scenario file (see `scenario list`)
    #[arg(default_value = scenario::DEFAULT)]
    scenario: String,
    #[command(flatten)]
    draws: Draws,
    /// Which scenes: thesis or train (201 distances, every 2.5 mm), test (51, every 10 mm), KEY=FROM..TO:STEP
    /// or KEY=A,B,C of any numeric key of the scenario (may be repeated), or a TOML file of those
    /// [default: the scenario's training.grid, or else thesis]
    #[arg(long, value_name = "GRID")]
    grid: Vec<String>,
    /// Histograms per scene, unless --rows is given
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..))]
    repeats: u64,
    /// Formats to write, separated by commas
    #[arg(long, value_parser = words(choice::DATASET_FORMAT), value_delimiter = ',', default_value = "parquet")]
    format: Vec<DatasetFormat>,
    /// Write the files and dataset.json, their description, into this folder
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let load = |set: &[String]| args.draws.load(&args.scenario, set);
    let scenes = Scenes::new(&args.grid, &args.draws.set, GridPurpose::Training, load)?;
    let notes = scenes.notes()?;
    console.print_notes(&notes)?;
    let (source, setup) = (&scenes.source, &scenes.setups[0]);
    let seed = setup.scenario.seed;
    let grid = Grid { repeats: args.repeats, ..scenes.grid };
    let rows = args.draws.rows(None, &grid, seed)?;
    let description =
        DatasetDescription::new(setup, (&console.command, &args.format), source, &rows, seed);
    let _held = FolderLock::take(&args.output)?;
    let files = DatasetFiles::create(&args.output, &args.format, &description, &grid)?;
    let stop = stop_signal();
    let blocks = source.blocks(&rows, seed);
    let written = args
        .draws
        .on_threads(rows.count(), console, |done| write(files, blocks, stop.as_deref(), done))?;
    written.iter().for_each(|path| console.wrote(path));

    let files = written.iter().map(|path| path.display().to_string()).collect();
    let findings = DatasetFindings { description, files, notes };
    Report::without_record(findings).deliver(None, args.json, console)
}

/// A dataset that was written.
#[derive(Serialize)]
struct DatasetFindings {
    #[serde(flatten)]
    description: DatasetDescription,
    files: Vec<String>,
    notes: Vec<Note>,
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
        poll_stop(stop)?;
        let (written, drawn) = rayon::join(|| files.write(&block), || blocks.next());
        written?;
        done(block.len() as u64);
        next = drawn;
    }
    files.finish()
}

impl Findings for DatasetFindings {
    const SCHEMA: &'static str = "tofsim.dataset/1";

    fn json(&self) -> Value {
        json!(self)
    }

    fn text(&self) -> String {
        let description = &self.description;
        let choice = if description.subset { "random scenes of " } else { "" };
        let shots =
            description.shots_per_frame.map(|shots| format!("{} each", grouped(shots.into())));
        let rows = [
            ("scenario", description.scenario.clone()),
            ("chain", description.profile.clone()),
            ("grid", format!("{choice}{}", description.grid)),
            ("histograms", grouped(description.rows)),
            ("shots", shots.unwrap_or("as in the grid".to_owned())),
            ("seed", description.seed.to_string()),
        ];
        let axes = description.axes.iter().flatten();
        let axes = axes.map(|Axis { key, text, .. }| ("", format!("{key} = {text}")));
        let files = self.files.iter().map(|file| ("file", file.clone()));
        let array = description.array.iter();
        let array = array.map(|of| ("array", format!("{} x {} pixels", of.rows, of.columns)));
        let (head, tail) = rows.split_at(3);
        format!(
            "{}\n",
            facts(
                array
                    .chain(head.iter().cloned())
                    .chain(axes)
                    .chain(tail.iter().cloned())
                    .chain(files)
            )
        )
    }
}
