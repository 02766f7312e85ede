//! `tofsim run`: photons to depth.

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::error::Result;
use crate::hierarchy;
use crate::output::create_directory;
use crate::report::products::Products;
use crate::report::summary::Summary;
use crate::report::table;
use crate::scenario;
use crate::sim::frames::Frame;
use crate::sim::recorder::Shot;
use crate::sim::run::Watch;
use crate::sim::setup::Setup;
use crate::sim::window::Window;
use crate::sim::{Outcome, Run};
use crate::waves::{self, Format, Waves, write_views};

use super::interrupt::stop_signal;
use super::stdout::print;
use super::talk::Talk;

/// Simulate frames: photons to depth, with a waveform
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim run                              one frame of the built-in kc705, waveform in waves/\n  \
    tofsim run far --frames 20 --waves none\n  \
    tofsim run -s target.distance_m=0.3 --seed 7 -o out\n  \
    tofsim run --window 10us..12us --signals 'tdc.*' --waves fst")]
pub struct Args {
    /// Built-in scenario, or the path of a scenario file (see `scenario list`)
    #[arg(default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a key of the scenario, such as target.distance_m=0.3; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    seed: Option<u64>,
    /// How many frames to simulate, one after the other
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = clap::value_parser!(u64).range(1..))]
    frames: u64,
    /// How to simulate; this version has the cycle-accurate model only
    #[arg(long, value_enum, default_value_t = Fidelity::Cycle)]
    fidelity: Fidelity,
    /// Format of the waveform
    #[arg(long, value_enum, default_value_t = WavesFormat::Vcd)]
    waves: WavesFormat,
    /// Part of the run that goes into the waveform: shot:0..8, 10us..12us or estimation; may be
    /// repeated [default: the scenario's, or shot:0..16 and estimation]
    #[arg(long, value_name = "W", value_parser = str::parse::<Window>)]
    window: Vec<Window>,
    /// Signals that go into the waveform, by name or path with * and ?; may be repeated
    /// [default: all but the histogram's RAM]
    #[arg(long, value_name = "GLOB")]
    signals: Vec<String>,
    /// Write a row for each shot, as .csv or .parquet
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    /// Write summary.json, histogram.csv, histogram.svg and the waveform there
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Fidelity {
    /// Every register at every edge
    Cycle,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum WavesFormat {
    /// Value change dump
    Vcd,
    /// GTKWave's compressed format
    Fst,
    /// No waveform
    None,
}

/// Runs the command.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    let Fidelity::Cycle = args.fidelity;
    let mut loaded = scenario::load(&args.scenario, &args.set)?;
    if let Some(seed) = args.seed {
        loaded.scenario.seed = seed;
    }
    let setup = Setup::new(loaded)?;
    let plan = WavePlan::new(args, &setup)?;
    let (folder, events) = (args.output.as_deref(), args.events.as_deref());
    let mut products = Products::new(folder, events, &provenance(args, &setup), &setup)?;
    let waves = plan.as_ref().map(|plan| plan.open(args, &setup)).transpose()?;

    let stop = stop_signal();
    let progress = talk.progress(args.frames);
    let mut frames: Vec<Frame> = Vec::new();
    let mut take_frame = |frame: &Frame| {
        frames.push(frame.clone());
        progress.inc(1);
        Ok(())
    };
    let wants_shots = products.want_shots();
    let mut take_shot = |shot: &Shot| products.shot(shot);
    let watch = Watch {
        waves,
        shots: wants_shots.then_some(&mut take_shot),
        frames: Some(&mut take_frame),
        stop: stop.as_deref(),
    };
    let began = Instant::now();
    let outcome = Run::new(&setup).frames(args.frames, watch)?;
    let wall = began.elapsed();
    progress.finish_and_clear();
    outcome.notes.iter().chain(&setup.notes()).for_each(|note| talk.note(note));

    if let Some(plan) = &plan {
        for view in write_views(&plan.path, plan.format, &plan.entries, &outcome.marks)? {
            talk.detail(format_args!("wrote {}", view.display()));
        }
        talk.note(format_args!("waveform: {}", plan.path.display()));
    }
    let waves = plan.map(|plan| plan.path.display().to_string());
    let summary = Summary::new(&setup, waves, &frames, products.tdc());
    for path in products.finish(&setup, &frames, &summary)? {
        talk.detail(format_args!("wrote {}", path.display()));
    }
    print(&text(args, &setup, &frames, &outcome, &summary, wall)?)
}

fn text(
    args: &Args,
    setup: &Setup,
    frames: &[Frame],
    outcome: &Outcome,
    summary: &Summary,
    wall: std::time::Duration,
) -> Result<String> {
    if args.json {
        return summary.json();
    }
    let mut text = table::run(setup, frames, outcome, wall);
    if let Some(results) = &summary.tdc {
        text += &table::tdc(results);
    }
    Ok(text)
}

/// The waveform: what goes into it, and where.
struct WavePlan {
    path: PathBuf,
    format: Format,
    entries: Vec<hierarchy::Entry>,
    windows: Vec<Window>,
}

impl WavePlan {
    fn new(args: &Args, setup: &Setup) -> Result<Option<Self>> {
        let (format, ending) = match args.waves {
            WavesFormat::None => return Ok(None),
            WavesFormat::Vcd => (Format::Vcd, "vcd"),
            WavesFormat::Fst => (Format::Fst, "fst"),
        };
        let entries = hierarchy::entries(&setup.params);
        let entries = waves::select(entries, hierarchy::ram_entries(), &args.signals)?;
        let windows = setup.windows(&args.window, args.frames)?;
        let folder = args.output.as_deref().unwrap_or(Path::new("waves"));
        create_directory(folder)?;
        let path = folder.join(format!("{}.{ending}", setup.name));
        Ok(Some(WavePlan { path, format, entries, windows }))
    }

    fn open(&self, args: &Args, setup: &Setup) -> Result<(Waves, Vec<Window>)> {
        let (order, provenance) = (setup.params.tdc.delays.order(), provenance(args, setup));
        let waves = Waves::create(&self.path, self.format, &self.entries, order, &provenance)?;
        Ok((waves, self.windows.clone()))
    }
}

/// Who made a file, from what.
fn provenance(args: &Args, setup: &Setup) -> Vec<String> {
    let mut lines = vec![
        format!("tofsim {}", env!("CARGO_PKG_VERSION")),
        format!("scenario {}", setup.name),
        format!("seed {}", setup.scenario.seed),
    ];
    lines.extend(args.set.iter().map(|set| format!("set {set}")));
    lines
}
