//! `tofsim compare`: two waveforms, captures or simulations laid over each other.

pub(super) mod values;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use values::{latency, time, tolerance, valid};

use tofsim::error::{Error, Input, Result, read_text};
use tofsim::kernel::Time;
use tofsim::{Note, NoteCode, NoteValue};
use tofsim_captures::choice::SignalChoice;
use tofsim_captures::compare::map::Rule;
use tofsim_captures::compare::{Align, Options, SampleClock, SignalMap, Unknowns, compare};
use tofsim_captures::condition::Condition;
use tofsim_captures::ila::{AnalyserSetup, Radix};
use tofsim_captures::source::Source;

use crate::choice::{self, seed, words};
use crate::record::Record;
use crate::report::comparison::{self, ComparisonFindings};
use crate::report::writer::Report;

use super::draws::load;
use super::host::host;
use super::instrument::Instrument;
use super::terminal::Console;

/// Compare two waveforms or captures: A is the reference, B the capture under test
///
/// A and B are VCD, FST, GHW, or a logic analyser's CSV, VCD or .ila archive; the contents decide, not the name. With
/// --scenario, A is a simulation and only B is given. Signals are matched by name or the end of a name (`tdc/hit` is
/// `tof_top.tdc.hit`), or as a map says; so may SIGNAL below.
///
/// A CONDITION has the form `state == 5 && (start rising || code[7:4] != 0b1x0x)`; TIME has the form 10us or 8.5ns.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim compare waves/kc705.vcd verilog.vcd\n  \
    tofsim compare waves/run.vcd board.ila --map fig_6_6\n  \
    tofsim compare --scenario near board.csv --clock clk_sys --align correlation\n  \
    tofsim compare a.fst b.ila --clock clk --beats 'valid && ready'\n  \
    tofsim compare a.fst b.fst --clock clk_sys --latency depth=2 --waves both.vcd\n\n\
    Exit status: 0 same, 1 different, 2 cannot be compared.")]
pub struct Args {
    /// The reference and the capture under test; one file with --scenario
    #[arg(required = true, num_args = 1..=2, value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    simulated: Simulated,
    #[command(flatten)]
    which: Which,
    #[command(flatten)]
    when: When,
    #[command(flatten)]
    how: How,
    /// Compare the words of a bus regardless of their timing: those at samples that meet this CONDITION, e.g. `valid
    /// && ready`
    #[arg(long, value_name = "CONDITION")]
    beats: Option<String>,
    /// Write both sides and their differences as one waveform, with save files for GTKWave and Surfer
    #[arg(long, value_name = "FILE.vcd")]
    waves: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Also write JUnit XML
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
}

/// The side that is simulated.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Simulated side")]
struct Simulated {
    /// Simulate a scenario as the reference
    #[arg(long, value_name = "NAME|FILE")]
    scenario: Option<String>,
    /// Set a scenario key, e.g. `target.distance_m=0.3`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE", requires = "scenario")]
    set: Vec<String>,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N", requires = "scenario", value_parser = seed())]
    seed: Option<u64>,
    /// How many frames, or images of an array, to simulate at most [default: as far as a capture goes, to 100 ms, of
    /// which a search for the best fit takes the first frame; one frame for a waveform]
    #[arg(long, value_name = "N", requires = "scenario",
        value_parser = clap::value_parser!(u64).range(1..))]
    frames: Option<u64>,
}

/// Which signals.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Which signals")]
struct Which {
    /// Match signals by a map file, or by a probe configuration of `ila capture` (name or path)
    #[arg(long, value_name = "FILE|NAME")]
    map: Option<String>,
    /// Compare only matching signals, with * and ?; may be repeated
    #[arg(long, value_name = "GLOB")]
    signals: Vec<String>,
    /// Ignore matching signals, with * and ?; may be repeated
    #[arg(long, value_name = "GLOB")]
    ignore: Vec<String>,
    /// Count signals without a counterpart as differences in waveforms, as in captures
    #[arg(long)]
    all: bool,
    /// Radix of the values in a CSV without radices
    #[arg(long, value_parser = words(choice::RADIX))]
    radix: Option<Radix>,
}

/// When.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "When")]
struct When {
    /// Take samples of waveforms just before the rising edges of a signal or, as 100MHz + 250ps, of
    /// a custom clock [default: at each change]
    #[arg(long, value_name = "CLOCK")]
    clock: Option<SampleClock>,
    /// start, trigger, edge SIGNAL, correlation [SIGNAL,...], windows [SIGNAL,...], offset N
    /// (samples) or offset 8ns [default: trigger of captures; correlation of a capture with a
    /// waveform, windows if it has several; time of waveforms]
    #[arg(long, value_name = "HOW", allow_hyphen_values = true)]
    align: Option<Align>,
    /// Trigger of a waveform, as `start rising && mode == 0`
    #[arg(long, value_name = "CONDITION")]
    trigger: Option<String>,
    /// Ignore waveforms before this time, e.g. 10us
    #[arg(long, value_name = "TIME", value_parser = time)]
    after: Option<Time>,
    /// Stop comparing at this time
    #[arg(long, value_name = "TIME", value_parser = time)]
    until: Option<Time>,
    /// Condition under which the analyser stored a sample
    #[arg(long, value_name = "CONDITION")]
    qualified_by: Option<String>,
    /// Signal of the capture that counts clock edges, for captures that do not contain every edge
    #[arg(long, value_name = "SIGNAL")]
    time_from: Option<String>,
}

/// Tolerances of the comparison.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "How exactly")]
struct How {
    /// Treat an unknown bit as equal to
    #[arg(long, value_parser = words(choice::UNKNOWNS), default_value = "exact")]
    x: Unknowns,
    /// Largest difference of a number to accept, in units of its last place; may be repeated
    #[arg(long, value_name = "SIGNAL=N", value_parser = tolerance)]
    tolerance: Vec<(String, u64)>,
    /// Number of samples by which a signal is later in B (negative: earlier); may be repeated
    #[arg(long, value_name = "SIGNAL=N", value_parser = latency, allow_hyphen_values = true)]
    latency: Vec<(String, i64)>,
    /// Compare a signal only where another is 1 in A; may be repeated
    #[arg(long, value_name = "SIGNAL=VALID", value_parser = valid)]
    valid: Vec<(String, String)>,
}

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<ExitCode> {
    let radix = args.which.radix;
    let stop = host().map(|host| host.stop).unwrap_or_default();
    let open = |path: &PathBuf| Source::file_stopped_by(path, radix, Arc::clone(&stop));
    let Simulated { scenario, set, seed, frames } = &args.simulated;
    let (mut notes, mut record) = (Vec::new(), None);
    let (a, b) = match (scenario, &args.files[..]) {
        (Some(scenario), [b]) => {
            let instrument = Instrument::new(load(scenario, set, *seed)?)?;
            notes = instrument.notes()?;
            console.print_notes(&notes)?;
            let Instrument { setup, array } = instrument;
            let b = open(b)?;
            let frames = frames.or((!b.is_capture()).then_some(1));
            super::frames::check("--frames", frames.unwrap_or(1), &setup)?;
            record = Some(Record::new(&setup, &console.command).into());
            let a = match array {
                None => Source::simulation(setup, frames),
                Some(array) => Source::array_simulation(array, frames)?,
            };
            (a.stopped_by(Arc::clone(&stop)), b)
        }
        (None, [a, b]) => (open(a)?, open(b)?),
        (given, _) => {
            let expected = match given {
                Some(_) => "expected one file: the other side is the scenario's",
                None => "expected two files, or one and --scenario",
            };
            return Err(Input::new("compare", expected).into());
        }
    };
    no_input_is_written(args)?;
    let options = options(args)?;
    let result = compare(&a, &b, &options)?;
    if let Some(path) = &args.junit {
        comparison::write_junit(path, &result)?;
        console.wrote(path);
    }
    options.waves.iter().for_each(|path| console.wrote_wave(path));
    let remark =
        |text: &String| Note::new(NoteCode::Comparison, "compare", NoteValue::None, "", text);
    notes.extend(result.notes.iter().map(remark));
    let findings = ComparisonFindings { result: &result, notes: &notes, verbose: console.verbose };
    Report { findings, record, notes: &notes }.deliver(None, args.json, console)?;
    console.none_skipped(&result.skipped)?;
    Ok(ExitCode::from(u8::from(!result.is_same())))
}

/// Checks that no compared file is overwritten.
fn no_input_is_written(args: &Args) -> Result<()> {
    let outputs = [("--waves", &args.waves), ("--junit", &args.junit)];
    for (option, path) in outputs.into_iter().filter_map(|(o, path)| Some((o, path.as_ref()?))) {
        let written = [path.clone(), path.with_extension("gtkw"), path.with_extension("sucl")];
        let place = |path: &Path| std::fs::canonicalize(path).ok();
        let same = |input: &PathBuf| {
            written.iter().any(|path| place(path).is_some() && place(path) == place(input))
        };
        if args.files.iter().any(same) {
            let expected = "expected another file than those that are compared";
            return Err(Input::new(option, expected).value(path.display()).into());
        }
    }
    Ok(())
}

fn options(args: &Args) -> Result<Options> {
    let condition = |option: &str, text: &Option<String>| {
        text.as_ref().map(|text| Condition::parse(option, text)).transpose()
    };
    let mut map = args.which.map.as_deref().map(named_map).transpose()?.unwrap_or_default();
    map.signal.extend(rules(&args.how));
    let (when, which) = (&args.when, &args.which);
    Ok(Options {
        map,
        choice: SignalChoice { only: which.signals.clone(), ignore: which.ignore.clone() },
        clock: when.clock.clone(),
        align: when.align.clone(),
        trigger: condition("--trigger", &when.trigger)?,
        qualified_by: condition("--qualified-by", &when.qualified_by)?,
        time_from: when.time_from.clone(),
        after: when.after,
        until: when.until,
        unknowns: args.how.x,
        all: which.all,
        beats: condition("--beats", &args.beats)?,
        waves: args.waves.clone(),
    })
}

/// A map file, or the map of a set-up.
pub fn named_map(name: &str) -> Result<SignalMap> {
    let built_in = !name.contains(['/', '.']);
    let is_set_up = |path: &Path| {
        // A pipe can be read once only.
        path.is_file() && read_text(path).is_ok_and(|text| text.contains("[[probe]]"))
    };
    if built_in || is_set_up(Path::new(name)) {
        let set_up = AnalyserSetup::load(name);
        return Ok(SignalMap::of(&set_up.map_err(as_map)?));
    }
    SignalMap::read(Path::new(name))
}

/// The fault of a set-up that is not there, by the option that asked for it here.
fn as_map(error: Error) -> Error {
    match error {
        Error::Input(input) if input.source == "--probes" => {
            Input { source: "--map".to_owned(), ..*input }.into()
        }
        error => error,
    }
}

/// Returns the rules for single signals.
fn rules(how: &How) -> Vec<Rule> {
    let of = |name: &String| Rule { a: vec![name.clone()], ..Rule::default() };
    let tolerance = how.tolerance.iter().map(|(name, n)| Rule { tolerance: *n, ..of(name) });
    let latency = how.latency.iter().map(|(name, n)| Rule { latency: *n, ..of(name) });
    let valid = how.valid.iter().map(|(name, v)| Rule { valid: Some(v.clone()), ..of(name) });
    tolerance.chain(latency).chain(valid).collect()
}
