//! `tofsim run`: photons to depth.

use std::path::PathBuf;
use std::time::Instant;

use tofsim::error::{Error, Input, Result};
use tofsim::files::folder::FolderLock;
use tofsim::scenario;
use tofsim::scenario::window::Window;
use tofsim::sim::fast::histogram::Histograms;
use tofsim::sim::frames::Frame;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim::sim::shot_recorder::Shot;
use tofsim::sim::transactions::Transaction;
use tofsim::sim::{Outcome, Run};
use tofsim::waves::{WaveFormat, Waves};
use tofsim::{Callback, Note};
use tofsim_learn::dataset::transaction_file::TransactionFile;
use tofsim_learn::estimation::notes::notes_of_firmware;
use tofsim_learn::estimation::{EstimatorKind, Needs, Panel};

use crate::choice::{self, Fidelity, WaveformChoice, seed, words};
use crate::record::{LazyRecord, Record};
use crate::report::frame_log::FrameLog;
use crate::report::run_files::{RunFiles, check_name, is_same};
use crate::report::statistics::second_opinion;
use crate::report::summary::Summary;
use crate::report::table;

use super::draws::{load, use_threads};
use super::frames;
use super::pixel::PixelPlace;
use super::terminal::{Console, print_with, stop_signal};
use super::wave_plan::{SignalArgs, WavePlan};

/// Simulate frames: photons to depth, with a waveform
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim run                           one frame of kc705, waveform in waves/\n  \
    tofsim run far --frames 20 --waves none\n  \
    tofsim run far --frames 1000 --fidelity shot\n  \
    tofsim run --estimator subtraction   a dark and a lit frame of 15,000 shots\n  \
    tofsim run -s target.distance_m=0.3 --seed 7 -o out\n  \
    tofsim run --window 10us..12us --signals 'tdc.*' --waves fst\n  \
    tofsim run --transactions run.ftr   each photon, from its arrival to its bin")]
pub struct Args {
    /// Built-in scenario, or the path of a scenario file (see `scenario list`)
    #[arg(default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a scenario key, e.g. `target.distance_m=0.3`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N", value_parser = seed())]
    seed: Option<u64>,
    /// Number of frames; with dark frames, number of pairs
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    frames: u64,
    /// Simulation fidelity: cycle and shot give identical frames, histogram frames of the same distribution
    #[arg(long, value_parser = words(&Fidelity::ALL), default_value = "cycle")]
    fidelity: Fidelity,
    /// Threads for the frames of a run without waveform, events and transactions; the results are the same for
    /// any number [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Format of the waveform [default: vcd; none for fidelities without signals]
    #[arg(long, value_parser = words(choice::WAVEFORM))]
    waves: Option<WaveformChoice>,
    #[command(flatten)]
    shown: SignalArgs,
    /// Additional estimators for each frame's histogram, separated by commas; with subtraction, frames are pairs of a
    /// dark and a lit one (firmware.dark_frames) for all estimators
    #[arg(long, value_parser = words(EstimatorKind::ALL), value_delimiter = ',')]
    estimator: Vec<EstimatorKind>,
    /// Pixel of an array to simulate: its row from the top and its column from the left, from 0
    #[arg(long, value_name = "ROW,COL")]
    pixel: Option<PixelPlace>,
    /// Do not run the likelihood estimator on each frame for comparison
    #[arg(long)]
    no_second_opinion: bool,
    /// Error above which a depth is an outlier [mm]
    #[arg(long, value_name = "MM", default_value_t = 100.0, value_parser = choice::millimetres)]
    outlier_limit_mm: f64,
    /// Write a row per shot, as .csv or .parquet
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    /// Write shots, photons, hits, codes, counts and estimations with begin, end and attributes, as .ftr or .parquet
    #[arg(long, value_name = "FILE")]
    transactions: Option<PathBuf>,
    /// Write summary.json, histogram.csv, histogram.svg and the waveform into this folder
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Receives the frames one by one.
type TakeFrame<'a> = &'a mut dyn FnMut(&Frame) -> Result<()>;

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let waves = args.waves_format()?;
    let loaded = load(&args.scenario, &args.overrides(), args.seed)?;
    let setup = match args.pixel {
        None => Setup::new(loaded)?,
        Some(pixel) => pixel.setup(loaded)?,
    };
    args.check_fidelity(&setup)?;
    args.check_pairs(&setup)?;
    let mut notes = setup.notes()?;
    notes.extend(notes_of_firmware(&setup));
    notes.extend(args.estimator.iter().flat_map(|kind| kind.notes_of_scene(&setup)));
    console.print_notes(&notes)?;
    let frames = args.frames * setup.frames_together();
    let is_drawn = args.fidelity == Fidelity::Histogram;
    let histograms = is_drawn.then(|| Histograms::new(&setup)).transpose()?;
    let plan = waves.map(|format| args.wave_plan(format, &setup, frames)).transpose()?;
    let home = plan.as_ref().and_then(|plan| plan.path.parent()).or(args.output.as_deref());
    let _held = home.map(FolderLock::take).transpose()?;
    let record = Record::lazy(&setup, &console.command);
    let mut files = RunFiles::new(args.output.as_deref(), args.events.as_deref(), &record, &setup)?;
    let mut transactions = args.transaction_file(&record)?;
    let waves = plan.as_ref().map(|plan| plan.open(&record, &setup)).transpose()?;
    use_threads(args.threads)?;
    let mut log = args.log(&setup, &mut notes, console)?;

    let progress = console.progress(frames, "frames");
    let began = Instant::now();
    let mut take_frame = |frame: &Frame| {
        progress.inc(1);
        log.push(frame)
    };
    let listening = (&mut files, transactions.as_mut());
    let outcome = args.simulate(&setup, histograms, (frames, &mut take_frame), waves, listening)?;
    let wall = began.elapsed();
    progress.finish_and_clear();
    log.settle()?;
    let mut late = outcome.notes;
    // What makes any depth impossible has been said.
    if setup.no_depth().is_none() {
        late.extend(log.notes());
    }
    console.print_notes(&late)?;
    notes.extend(late);

    let finish = |plan: &WavePlan| plan.finish(&outcome.marks);
    let mut written = plan.as_ref().map_or(Ok(Vec::new()), finish)?;
    written.extend(transactions.map(TransactionFile::finish).transpose()?);
    let waves = plan.map(|plan| plan.path.display().to_string());
    let fidelity = args.fidelity.name();
    let summary = Summary::new(&setup, fidelity, waves, &log, files.tdc(), &notes);
    files.finish(&record, &setup, &mut log, &summary, written)?.report(console);
    if args.json {
        return print_with(|out| summary.write(&record, &mut log, out));
    }
    let cycles = (!is_drawn).then_some(outcome.cycles);
    console.report(&table::run(&setup, &log, &summary, cycles, wall))
}

impl Args {
    /// Returns the log of the frames, with the estimators that look at them.
    fn log(&self, setup: &Setup, notes: &mut Vec<Note>, console: &Console) -> Result<FrameLog> {
        let panel = Panel::new(&self.estimator, setup)?;
        let wants_second = !self.no_second_opinion;
        let second = wants_second.then(|| second_opinion(setup, notes, console)).flatten();
        let json = self.json || self.output.is_some();
        Ok(FrameLog::new(setup, json, (panel, second), 1e-3 * self.outlier_limit_mm))
    }

    /// Begins the file of transactions, if it is wanted.
    fn transaction_file(&self, record: &LazyRecord) -> Result<Option<TransactionFile>> {
        let Some(path) = &self.transactions else { return Ok(None) };
        check_name("--transactions", Some(path), self.output.as_deref())?;
        if self.events.as_ref().is_some_and(|events| is_same(events, path)) {
            let expected = "expected another name than that of --events";
            return Err(Input::new("--transactions", expected).value(path.display()).into());
        }
        TransactionFile::create(path, &record.line()).map(Some)
    }

    /// Simulates so many frames: on several threads unless there is a waveform or every shot is wanted.
    fn simulate(
        &self,
        setup: &Setup,
        histograms: Option<Histograms>,
        (count, take_frame): (u64, TakeFrame),
        waves: Option<(Waves, Vec<Window>)>,
        (files, transactions): (&mut RunFiles, Option<&mut TransactionFile>),
    ) -> Result<Outcome> {
        let sees_shots = self.fidelity == Fidelity::Cycle && files.want_shots();
        let wants_all = files.want_all_shots() || transactions.is_some();
        let mut take_shot = |shot: &Shot| files.shot(shot);
        let mut take_transaction =
            transactions.map(|file| |transaction: &Transaction| file.write(transaction));
        let stop = stop_signal();
        let watch = Observers {
            waves,
            shots: sees_shots.then_some(&mut take_shot),
            transactions: take_transaction.as_mut().map(|take| take as Callback<Transaction>),
            frames: Some(take_frame),
            stop: stop.as_deref(),
        };
        let run = || Run::new(setup).stepping(self.fidelity.stepping());
        match histograms {
            Some(histograms) => histograms.many(count, watch),
            None if watch.waves.is_some() || wants_all => run().observe(count, watch),
            None => run().many(count, watch),
        }
    }

    fn wave_plan(&self, format: WaveFormat, setup: &Setup, frames: u64) -> Result<WavePlan> {
        let windows = setup.windows(&self.shown.window, frames)?;
        WavePlan::new((self.output.as_deref(), format), setup, &self.shown.signals, windows)
    }

    /// The format of the waveform, if there is one.
    fn waves_format(&self) -> Result<WaveformChoice> {
        match (self.fidelity, self.waves) {
            (Fidelity::Cycle, waves) => Ok(waves.unwrap_or(Some(WaveFormat::Vcd))),
            (_, None | Some(None)) => Ok(None),
            (_, Some(Some(_))) => Err(self.without_signals("--waves")),
        }
    }

    /// Returns the overrides of the scenario; --set goes last.
    fn overrides(&self) -> Vec<String> {
        let pairs = self.wants_pairs().then(|| "firmware.dark_frames=true".to_owned());
        pairs.into_iter().chain(self.set.iter().cloned()).collect()
    }

    fn wants_pairs(&self) -> bool {
        self.estimator.iter().any(|kind| kind.needs() == Needs::Dark)
    }

    /// Checks that there are pairs if an estimator needs them, and not too many.
    fn check_pairs(&self, setup: &Setup) -> Result<()> {
        let source = format!("scenario {}", setup.name);
        if self.wants_pairs() && !setup.has_pairs() {
            let expected = "expected true with --estimator subtraction";
            return Err(Input::new(source, expected)
                .field("firmware.dark_frames")
                .value(false)
                .into());
        }
        match self.fidelity {
            Fidelity::Histogram => frames::check_streams("--frames", self.frames, setup),
            _ => frames::check("--frames", self.frames, setup),
        }
    }

    /// Checks that the fidelity provides the requested outputs.
    fn check_fidelity(&self, setup: &Setup) -> Result<()> {
        if self.fidelity == Fidelity::Cycle {
            return Ok(());
        }
        let asked = [
            ("--events", self.events.is_some()),
            ("--transactions", self.transactions.is_some()),
            ("report.tdc", setup.scenario.report.tdc),
        ];
        match self.shown.given().iter().chain(&asked).find(|(_, asked)| *asked) {
            Some((option, _)) => Err(self.without_signals(option)),
            None => Ok(()),
        }
    }

    fn without_signals(&self, option: &str) -> Error {
        let fidelity = self.fidelity.name();
        let expected = format!(
            "--fidelity {fidelity} has neither signals nor single shots: expected --fidelity cycle"
        );
        Input::new(option, expected).into()
    }
}
