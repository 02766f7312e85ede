//! `tofsim board run`: frames of a board, in the form that `tofsim run` has.

use std::path::PathBuf;

use tofsim::error::Result;
use tofsim::files::folder::FolderLock;
use tofsim::sim::setup::Setup;
use tofsim_board::check_frames;
use tofsim_learn::estimation::Panel;

use crate::choice;
use crate::record::Record;
use crate::report::board_frames::{self, Formats, FrameFiles};
use crate::report::frame_log::FrameLog;
use crate::report::statistics::second_opinion;
use crate::report::summary::{BoardSummary, Summary};
use crate::verbs::options::ScenarioArgs;
use crate::verbs::terminal::{Console, print_with, stop_signal};

use super::connection::{LaserArgs, ParametersArgs, PortArgs};

/// Get consecutive frames of a board: depths, sigma, status and histograms
///
/// Depth words are those of the board, bit for bit. -o writes summary.json, the object of --json; --csv, --npy and
/// --parquet write the frames beside it.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim board run --frames 20 --laser --port /dev/ttyUSB0\n  \
    tofsim board run --laser --port /dev/ttyUSB0 -o out --csv --npy\n  \
    tofsim estimate out/histograms.npy --estimator likelihood")]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    #[command(flatten)]
    port: PortArgs,
    #[command(flatten)]
    parameters: ParametersArgs,
    #[command(flatten)]
    laser: LaserArgs,
    /// Number of frames
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    /// Do not run the likelihood estimator on each frame for comparison
    #[arg(long)]
    no_second_opinion: bool,
    /// Distance from the mean above which a depth is an outlier [mm]
    #[arg(long, value_name = "MM", default_value_t = 100.0, value_parser = choice::millimetres)]
    outlier_limit_mm: f64,
    /// Write summary.json into this folder
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    formats: Formats,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let setup = Setup::new(args.scenario.load(None)?)?;
    check_frames(&setup)?;
    let mut board = args.port.open(&setup, args.parameters)?;
    let mut notes: Vec<_> = args.laser.note().into_iter().collect();
    console.print_notes(&notes)?;
    let _held = args.output.as_deref().map(FolderLock::take).transpose()?;
    let record = Record::lazy(&setup, &console.command);
    let folder = args.output.as_deref();
    let mut files = FrameFiles::new(folder, args.formats, &record, (&setup, args.frames))?;
    let wants_second = args.laser.laser && !args.no_second_opinion;
    let second = wants_second.then(|| second_opinion(&setup, &mut notes, console)).flatten();
    let keeps_json = args.json || args.output.is_some();
    let panel = (Panel::default(), second);
    let limit_m = args.outlier_limit_mm * 1e-3;
    let mut log = FrameLog::new(&setup, keeps_json, panel, limit_m).measured();

    let stop = stop_signal();
    let progress = console.progress(args.frames.into(), "frames");
    let (laser, port) = (args.laser.laser, board.port().to_owned());
    board.take_frames(
        &setup,
        laser,
        args.frames.into(),
        stop.as_deref(),
        &mut |frame, state| {
            if laser {
                state.check_armed(&port)?;
            }
            progress.inc(1);
            files.write(frame)?;
            log.push(frame)
        },
    )?;
    progress.finish_and_clear();
    log.settle()?;
    let late = log.notes();
    console.print_notes(&late)?;
    notes.extend(late);

    let origin = BoardSummary {
        port,
        parameters_hash: format!("{:016x}", board.identity().parameters_hash),
        laser,
    };
    let summary = Summary::of_board(origin, &log, &notes);
    files.finish(&record, &mut log, &summary, console)?;
    if args.json {
        return print_with(|out| summary.write(&record, &mut log, out));
    }
    console.report(&board_frames::table(&setup, &log))
}
