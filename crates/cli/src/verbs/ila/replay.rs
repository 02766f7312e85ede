//! `tofsim ila replay`: a scenario from what a capture shows of the inputs.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use tofsim::error::{Input, Result};
use tofsim::files::folder::FolderLock;
use tofsim::files::output::write_bytes;
use tofsim::files::staged::StagedFolder;
use tofsim::scenario::builtin::Source as Files;
use tofsim::scenario::{Control, DEFAULT, Loaded, Scenario, load, show};
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode, NoteValue};
use tofsim_captures::compare::{SampleClock, SignalMap};
use tofsim_captures::ila::Radix;
use tofsim_captures::replay::{Located, Replay, ReplayKind, ReplayOptions, replay};
use tofsim_captures::source::Source;

use crate::choice::{self, words};
use crate::record::Record;
use crate::report::writer::{Findings, Report};
use crate::text::table::facts;
use crate::verbs::compare::named_map;
use crate::verbs::terminal::Console;

/// Convert the inputs in a capture to a scenario that replays the board's run
///
/// Codes of the TDC become photons that arrive within their bins, tdc_stop alone photons to half a
/// sample, codes of the ROM a list of codes, the histogram's readout a preloaded histogram, and
/// control signals a timeline. Signals are found by the firmware's names or by a map.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim ila replay board.ila --map my_ila.toml -o replay/scenario.toml")]
pub struct Args {
    /// CSV, VCD or .ila archive of an ILA
    capture: PathBuf,
    /// Scenario to write, with its list of photons or codes in the same folder
    #[arg(short, long, value_name = "FILE.toml")]
    output: PathBuf,
    /// Match signals by a map file, or by a probe configuration of `ila capture` (name or path)
    #[arg(long, value_name = "FILE|NAME")]
    map: Option<String>,
    /// The analyser's clock, clk_sys or clk_laser [default: the map's, or else clk_sys]
    #[arg(long, value_name = "CLOCK")]
    clock: Option<SampleClock>,
    /// Samples are not contiguous: a capture condition, which the map does not state, selected them
    #[arg(long)]
    qualified: bool,
    /// Replace the photon source by this part of the capture [default: the first of these that is probed]
    #[arg(long = "as", value_name = "KIND", value_parser = words(choice::REPLAY))]
    kind: Option<ReplayKind>,
    /// Radix of the values in a CSV without radices
    #[arg(long, value_parser = words(choice::RADIX))]
    radix: Option<Radix>,
    /// Scenario for everything that the capture does not show
    #[arg(long, value_name = "NAME|FILE", default_value = DEFAULT)]
    scenario: String,
    /// Set a scenario key, e.g. `target.distance_m=0.3`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let place = ReplayFiles::new(&args.output)?;
    let base = load(&args.scenario, &args.set)?;
    let setup = Setup::new(base.clone())?;
    let options = ReplayOptions {
        map: args.map.as_deref().map(named_map).transpose()?.unwrap_or_default(),
        clock: args.clock.clone(),
        qualified: args.qualified,
        kind: args.kind,
    };
    let replay = replay(&Source::file(&args.capture, args.radix)?, &setup, &options)?;
    let notes: Vec<Note> = replay.notes.iter().map(note).collect();
    let list = place.list(replay.kind);
    let _held = FolderLock::take(&place.folder)?;
    let stage = StagedFolder::new(&place.folder)?;
    let record = Record::new(&setup, &console.command);
    let staged = stage.path().join(&place.scenario);
    write_bytes(&stage.path().join(&list), record.comment_line() + &replay.list)?;
    let mut scenario = replayed(base, &replay, &list)?;
    let write = |scenario: &Scenario| {
        write_bytes(&staged, record.comment_line() + &show::show(scenario))?;
        Setup::new(load(&staged.display().to_string(), &[])?)
    };
    let located = replay.locate(&write(&scenario)?)?;
    if !located.changes.is_empty() {
        scenario.control = located.changes.clone();
        write(&scenario)?;
    }
    let files = [&place.scenario, &list].map(|name| place.folder.join(name));
    stage.commit()?;
    files.iter().for_each(|file| console.wrote(file));
    let next = next(args, &options.map, &located);
    let findings = ReplayFindings { replay: &replay, located: &located, files: &files, next };
    Report::new(findings, &setup, &notes, console).deliver(None, args.json, console)
}

fn note(text: &String) -> Note {
    Note::new(NoteCode::Comparison, "capture", NoteValue::None, "", text)
}

/// Paths of the files.
struct ReplayFiles {
    folder: PathBuf,
    scenario: String,
    stem: String,
}

impl ReplayFiles {
    fn new(output: &Path) -> Result<Self> {
        let stem = output.file_stem().and_then(|stem| stem.to_str());
        let (Some(stem), Some("toml")) = (stem, output.extension().and_then(|e| e.to_str())) else {
            let expected = "expected a scenario file, as replay/scenario.toml";
            return Err(Input::new("--output", expected).value(output.display()).into());
        };
        let folder = output.parent().filter(|folder| !folder.as_os_str().is_empty());
        Ok(ReplayFiles {
            folder: folder.unwrap_or(Path::new(".")).to_owned(),
            scenario: format!("{stem}.toml"),
            stem: stem.to_owned(),
        })
    }

    /// Name of the list beside it.
    fn list(&self, kind: ReplayKind) -> String {
        format!("{}.{kind}.csv", self.stem)
    }
}

/// The scenario with what the capture shows, but for changes of the control signals.
fn replayed(base: Loaded, replay: &Replay, list: &str) -> Result<Scenario> {
    let Loaded { name, mut scenario, files, .. } = base;
    // Files are named from the scenario's own folder, which is another now.
    if let Files::Folder(folder) = files {
        for file in [&mut scenario.tdc.profile, &mut scenario.estimator.network] {
            if file.contains(['/', '.']) {
                let path = std::path::absolute(folder.join(&*file));
                let path = path.map_err(tofsim::error::Error::io(&folder, "read"))?;
                *file = path.display().to_string();
            }
        }
    }
    scenario.description = format!("What a capture shows, replayed; the rest is {name}");
    let stimulus = &mut scenario.stimulus;
    (stimulus.photons, stimulus.codes, stimulus.histogram) = (None, None, None);
    let list = Some(list.to_owned());
    match replay.kind {
        ReplayKind::Photons => stimulus.photons = list,
        ReplayKind::Codes => stimulus.codes = list,
        ReplayKind::Histogram => stimulus.histogram = list,
    }
    let firmware = &mut scenario.firmware;
    let periods = &firmware.laser_periods;
    let of_period =
        replay.period().and_then(|period| periods.iter().position(|own| *own == period));
    let Control { laser_freq, mode, laser_en, dsp_en, dsp_rst, rst, .. } = replay.begin();
    let laser_freq = laser_freq.or(of_period.map(|code| code as u64));
    firmware.laser_freq = laser_freq.unwrap_or(firmware.laser_freq);
    firmware.mode = mode.unwrap_or(firmware.mode);
    firmware.laser_en = laser_en.unwrap_or(firmware.laser_en);
    firmware.dsp_en = dsp_en.unwrap_or(firmware.dsp_en);
    firmware.dsp_rst = dsp_rst.unwrap_or(firmware.dsp_rst);
    firmware.rst = rst.unwrap_or(firmware.rst);
    firmware.shots_per_frame = replay.shots_per_frame().unwrap_or(firmware.shots_per_frame);
    Ok(scenario)
}

/// Quotes a word of a command line for a shell, if necessary.
fn quoted(word: String) -> String {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"_-./,:=+@%".contains(&byte);
    if word.bytes().all(is_plain) { word } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

/// The command that compares the capture with its replay, with what the map does not say.
fn next(args: &Args, map: &SignalMap, located: &Located) -> String {
    let mut words = vec!["tofsim compare --scenario".to_owned()];
    words.push(quoted(args.output.display().to_string()));
    words.push(quoted(args.capture.display().to_string()));
    words.extend(args.map.iter().map(|map| format!("--map {}", quoted(map.clone()))));
    match &args.clock {
        Some(SampleClock::Signal(clock)) => words.push(format!("--clock {clock}")),
        _ if map.clock.is_none() => words.push("--clock clk_sys".to_owned()),
        _ => {}
    }
    let radix = choice::RADIX.iter().find(|(_, radix, _)| Some(*radix) == args.radix);
    words.extend(radix.map(|(word, ..)| format!("--radix {word}")));
    let by_trigger = map.align.as_deref() == Some("trigger") && map.trigger.is_none();
    match located.offset {
        Some(offset) => words.push(format!("--align 'offset {offset}'")),
        None if by_trigger => words.push("--align correlation".to_owned()),
        None => {}
    }
    words.join(" ")
}

/// Results of a replay.
struct ReplayFindings<'a> {
    replay: &'a Replay,
    located: &'a Located,
    files: &'a [PathBuf; 2],
    next: String,
}

impl Findings for ReplayFindings<'_> {
    const SCHEMA: &'static str = "tofsim.ila_replay/1";

    fn json(&self) -> Value {
        json!({
            "kind": self.replay.kind.to_string(),
            "entries": self.replay.entries,
            "shots": self.replay.shots(),
            "shots_per_frame": self.replay.shots_per_frame(),
            "control_changes": self.located.changes.len(),
            "offset": self.located.offset,
            "files": self.files.each_ref().map(|file| file.display().to_string()),
            "next": self.next,
        })
    }

    fn text(&self) -> String {
        let Replay { kind, entries, .. } = self.replay;
        let unknown = || "not in the capture".to_owned();
        let per_frame = self.replay.shots_per_frame();
        let rows = [
            (
                "replayed",
                format!(
                    "{entries} {}",
                    if *kind == ReplayKind::Histogram { "words" } else { (*kind).into() }
                ),
            ),
            ("shots", self.replay.shots().to_string()),
            ("a frame", per_frame.map_or_else(unknown, |shots| format!("{shots} shots"))),
            ("control", format!("{} changes", self.located.changes.len())),
            ("next", self.next.clone()),
        ];
        let notes = self.replay.notes.iter().map(|note| ("note", note.clone()));
        format!("{}\n", facts(rows.into_iter().chain(notes)))
    }
}
