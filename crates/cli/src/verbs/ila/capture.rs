//! `tofsim ila capture`: a simulation through a logic analyser, into Vivado's files.

use std::path::PathBuf;

use serde_json::{Value, json};

use tofsim::error::{Error, Input, Result};
use tofsim::files::folder::FolderLock;
use tofsim::files::output::write_bytes;
use tofsim::files::staged::StagedFolder;
use tofsim::kernel::Time;
use tofsim::sim::Run;
use tofsim::sim::setup::Setup;
use tofsim_captures::compare::SignalMap;
use tofsim_captures::ila::export::{CaptureFormat, export};
use tofsim_captures::ila::{
    Analyser, AnalyserPlan, AnalyserSetup, Capture, capture, capture_array,
};

use crate::choice::{self, seed, words};
use crate::record::Record;
use crate::report::writer::{Findings, Report};
use crate::text::table::facts;
use crate::verbs::draws::load;
use crate::verbs::frames::check as check_frames;
use crate::verbs::instrument::Instrument;
use crate::verbs::interrupt::look_no_more;
use crate::verbs::terminal::{Console, stop_signal};

/// Sample a simulation as a logic analyser on the board would, and write Vivado's files
///
/// A probe configuration names the probes, the clock, the buffer and the trigger; options override its keys.
/// Conditions are as `state == 5 && (start rising || code[7:4] != 0b1x0x)`, over names of probes and paths of
/// signals. A sample is the value just before the edge.
///
/// Of an array, the firmware that scans it is simulated, until the buffer is full. channel_7.code is a signal of
/// column 7, and frames are images.
///
/// The files have the format of real captures, but have not been opened in Vivado yet.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim ila capture --probes fig_6_21 -o out\n  \
    tofsim ila capture near --probes my_ila.toml --trigger 'hit rising' -o out\n  \
    tofsim ila capture --probes array -s array.rows=8 -s array.columns=6 -o out\n\n\
    Built-in probe configurations: array, fig_6_6, fig_6_12, fig_6_13, fig_6_21 (screen captures of the thesis), likelihood_estimator, shot")]
pub struct Args {
    /// Built-in scenario or the path of a scenario file [default: that of the probe configuration]
    scenario: Option<String>,
    /// Built-in probe configuration, or the path of a file
    #[arg(long, value_name = "NAME|FILE")]
    probes: String,
    /// Directory to write to
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Set a scenario key, e.g. `target.distance_m=0.3`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N", value_parser = seed())]
    seed: Option<u64>,
    /// Largest number of frames, or of images of an array, to simulate [default: that of the probe configuration]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    frames: Option<u64>,
    #[command(flatten)]
    instead: Instead,
    /// Format to write; may be repeated [default: all]
    #[arg(long, value_parser = words(choice::CAPTURE_FORMAT))]
    format: Vec<CaptureFormat>,
    /// Omit the row of radices from the CSV, as Vivado before 2019.1
    #[arg(long)]
    legacy_csv: bool,
    /// End the simulation as soon as the buffer is full
    #[arg(long)]
    stop_when_full: bool,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Options in place of the probe configuration's keys.
#[derive(Clone, Debug, clap::Args)]
struct Instead {
    /// Sampling clock: clk_sys, clk_laser, clk_in, or frequency and first edge as 100MHz+250ps
    #[arg(long, value_name = "CLOCK")]
    clock: Option<String>,
    /// Samples of the buffer, a power of two from 1024 to 131072
    #[arg(long, value_name = "N")]
    depth: Option<u64>,
    /// Number of windows of the buffer, with a trigger each
    #[arg(long, value_name = "N")]
    windows: Option<u64>,
    /// Samples of a window before its trigger
    #[arg(long, value_name = "N")]
    position: Option<u64>,
    /// Trigger condition
    #[arg(long, value_name = "CONDITION")]
    trigger: Option<String>,
    /// Condition under which a sample is stored
    #[arg(long, value_name = "CONDITION")]
    capture: Option<String>,
    /// Time of arming, from power-up [us]
    #[arg(long, value_name = "T")]
    arm_at_us: Option<f64>,
    /// Registers before the probes, 0 to 6
    #[arg(long, value_name = "N")]
    stages: Option<u64>,
}

impl Instead {
    fn lay_over(&self, set_up: &mut AnalyserSetup) {
        let Instead { clock, depth, windows, position, .. } = self.clone();
        let Instead { trigger, capture, arm_at_us, stages, .. } = self.clone();
        set_up.override_with("clock", "--clock", clock, |file| &mut file.clock);
        set_up.override_with("depth", "--depth", depth, |file| &mut file.depth);
        set_up.override_with("windows", "--windows", windows, |file| &mut file.windows);
        set_up.override_with("position", "--position", position, |file| &mut file.position);
        set_up.override_with("trigger", "--trigger", trigger, |file| &mut file.trigger);
        set_up.override_with("capture", "--capture", capture, |file| &mut file.capture);
        set_up.override_with("arm_at_us", "--arm-at-us", arm_at_us, |file| &mut file.arm_at_us);
        set_up.override_with("input_stages", "--stages", stages, |file| &mut file.input_stages);
    }
}

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let mut set_up = AnalyserSetup::load(&args.probes)?;
    args.instead.lay_over(&mut set_up);
    let instrument = simulated(&set_up, args.scenario.as_deref(), &args.set, args.seed)?;
    let mut notes = instrument.notes()?;
    console.print_notes(&notes)?;
    let Instrument { setup, array } = instrument;
    let mut plan = AnalyserPlan::new(&set_up, &setup)?;
    plan.stop_when_full = args.stop_when_full || array.is_some();
    let frames = args.frames.unwrap_or(set_up.file.frames);
    check_frames("--frames", frames, &setup)?;
    let _held = FolderLock::take(&args.output)?;
    let mut analyser = Analyser::new(&plan, &setup);
    let stop = stop_signal();
    let (end, late) = match &array {
        None => {
            let outcome = capture(Run::new(&setup), frames, &mut analyser, stop.as_deref())?;
            (outcome.end, outcome.notes)
        }
        Some(array) => (capture_array(array, frames, &mut analyser, stop.as_deref())?, Vec::new()),
    };
    let (triggers, full) = (analyser.triggers(), analyser.is_full());
    if triggers.is_empty() {
        return Err(never(&set_up, &analyser, end));
    }
    look_no_more();
    let capture = analyser.finish();
    if !full {
        console.note(format_args!("note: the run ended with {}", missing(&plan, &capture)));
    }
    if !args.stop_when_full {
        console.print_notes(&late)?;
        notes.extend(late);
    }
    let formats = if args.format.is_empty() { CaptureFormat::ALL } else { &args.format };
    let stage = StagedFolder::new(&args.output)?;
    let files = export(&capture, stage.path(), &set_up.name, formats, !args.legacy_csv)?;
    // The map by which `tofsim compare` lays the capture over a waveform.
    let map = stage.path().join(format!("{}.map.toml", set_up.name));
    let record = Record::new(&setup, &console.command);
    write_bytes(&map, record.comment_line() + &SignalMap::of(&set_up).to_toml())?;
    // In the order of the formats.
    let names = files.iter().chain([&map]).filter_map(|file| file.file_name());
    let files: Vec<_> = names.map(|name| args.output.join(name)).collect();
    stage.commit()?;
    files.iter().for_each(|file| console.wrote(file));
    let files = files.iter().map(|file| file.display().to_string()).collect();
    let findings = CaptureFindings {
        set_up: &set_up,
        setup: &setup,
        plan: &plan,
        capture: &capture,
        trigger_times_us: triggers.into_iter().map(microseconds).collect(),
        full,
        end,
        files,
    };
    Report::new(findings, &setup, &notes, console).deliver(None, args.json, console)
}

/// Loads the scenario of a configuration, or the one that is given instead, with keys set.
pub(super) fn simulated(
    set_up: &AnalyserSetup,
    scenario: Option<&str>,
    set: &[String],
    seed: Option<u64>,
) -> Result<Instrument> {
    // What the configuration sets is meant for its own scenario.
    let own = if scenario.is_none() { &set_up.file.set[..] } else { &[] };
    let name = scenario.unwrap_or(&set_up.file.scenario);
    Instrument::new(load(name, &[own, set].concat(), seed)?)
}

/// Returns the error that nothing triggered, and the trigger.
fn never(set_up: &AnalyserSetup, analyser: &Analyser, end: Time) -> Error {
    let taken = analyser.taken();
    let expected =
        format!("never held before the run ended at {end}, after {taken} samples; nothing written");
    match &set_up.file.trigger {
        Some(trigger) => set_up.fault("trigger", trigger, expected),
        None => {
            let expected = format!(
                "expected enough samples before a trigger; the run ended at {end} with {taken}"
            );
            Input::new(format!("set-up {}", set_up.name), expected).into()
        }
    }
}

fn missing(plan: &AnalyserPlan, capture: &Capture) -> String {
    let (windows, depth) = (plan.shape.windows, plan.shape.depth);
    let last = capture.samples() - capture.windows.last().copied().unwrap_or(0);
    let full = capture.samples() / depth;
    let partial = if last.is_multiple_of(depth) { 0 } else { last };
    format!("{full} of {windows} windows of {depth} samples, and a last one of {partial}")
}

fn microseconds(time: Time) -> f64 {
    time.fs() as f64 / 1e9
}

/// Results of a capture.
struct CaptureFindings<'a> {
    set_up: &'a AnalyserSetup,
    setup: &'a Setup,
    plan: &'a AnalyserPlan,
    capture: &'a Capture,
    /// When each window triggered, from power-up.
    trigger_times_us: Vec<f64>,
    /// Whether every window has all its samples.
    full: bool,
    /// End of the run.
    end: Time,
    files: Vec<String>,
}

/// Trigger times that are shown.
const SHOWN: usize = 8;

impl Findings for CaptureFindings<'_> {
    const SCHEMA: &'static str = "tofsim.ila_capture/1";

    fn json(&self) -> Value {
        let (shape, capture) = (&self.plan.shape, self.capture);
        let probes = capture.probes.iter().zip(&self.set_up.file.probe);
        let probes = probes.map(|(probe, entry)| {
            json!({ "name": probe.head(), "signal": entry.signal, "width": probe.width })
        });
        json!({
            "name": self.set_up.name,
            "clock": self.plan.sampling.to_string(),
            "probes": probes.collect::<Vec<_>>(),
            "samples": capture.samples(),
            "window_depth": shape.depth,
            "windows": self.trigger_times_us.len(),
            "windows_wanted": shape.windows,
            "position": shape.position,
            "trigger_times_us": self.trigger_times_us,
            "full": self.full,
            "end_us": microseconds(self.end),
            "files": self.files,
        })
    }

    fn text(&self) -> String {
        let (shape, capture, times) = (&self.plan.shape, self.capture, &self.trigger_times_us);
        let bits: u32 = capture.probes.iter().map(|probe| probe.width).sum();
        let windows = format!(
            "{} of {}, {} samples, {} before the trigger",
            times.len(),
            shape.windows,
            shape.depth,
            shape.position
        );
        let shown: Vec<_> = times.iter().take(SHOWN).map(|time| format!("{time} us")).collect();
        let more = if times.len() > SHOWN { ", ..." } else { "" };
        let (scenario, seed) = (&self.setup.name, self.setup.scenario.seed);
        let rows = [
            ("scenario", format!("{scenario}, seed {seed}")),
            ("clock", self.plan.sampling.to_string()),
            ("probes", format!("{}, {bits} bits", capture.probes.len())),
            ("samples", capture.samples().to_string()),
            ("windows", windows),
            ("triggered", shown.join(", ") + more),
        ];
        let names = ["files"].into_iter().chain(std::iter::repeat(""));
        let rows = rows.into_iter().chain(names.zip(self.files.iter().cloned()));
        format!("{}: {}\n\n{}\n", self.set_up.name, self.set_up.file.description, facts(rows))
    }
}
