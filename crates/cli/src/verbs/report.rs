//! `tofsim report`: a page of a scenario.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use serde_json::{Value, json};

use tofsim::error::{Error, Input, Result, read_text};
use tofsim::files::folder::FolderLock;
use tofsim::files::output::write_bytes;
use tofsim::files::staged::{ScratchFolder, StagedFolder};
use tofsim::scenario::Loaded;
use tofsim::sim::setup::Setup;
use tofsim_captures::ila::AnalyserSetup;
use tofsim_learn::characterisation::Characterisation;
use tofsim_learn::error_budget::Plan;
use tofsim_learn::estimation::EstimatorKind;
use tofsim_learn::estimation::notes::notes_of_firmware;
use tofsim_rtl::verify::BlockReport;

use crate::choice::{seed, threads};
use crate::page::trace::{Trace, captured, wavejson};
use crate::record::{Record, read_object};
use crate::report::error_budget::DepthBudgets;
use crate::report::link_budget::LinkBudget;
use crate::report::scenario_page::{ReportPart, ScenarioPage};
use crate::report::tdc::TdcFindings;
use crate::report::verification::{CycleCounts, Verified};
use crate::report::writer::Findings as _;

use super::draws::use_threads;
use super::interrupt::look_no_more;
use super::options::ScenarioArgs;
use super::progress::Progress;
use super::terminal::{Console, RunCommand, print_json, stop_signal};
use super::verify;

mod words;

use words::Words;

/// Write an HTML report of a scenario: link budget, waveform, histogram, TDC, error budget, accuracy, cycles,
/// verification
///
/// The report is one file without scripts, for a screen, a phone or paper. Parts that the scenario does not allow are
/// omitted, with the reason.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim report far -o far\n  \
    tofsim report mine.toml -o mine --verify\n  \
    tofsim report -s tdc.profile=kintex7 -o k7 --quick\n\n\
    Exit status: 0 written, 1 the verification found a fault, 2 usage or input error.")]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Folder for report.html, report.json and waveform.json
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Use a tenth of the histograms
    #[arg(long)]
    quick: bool,
    /// Verify the Verilog against the model, and prove its cycle counts; takes minutes, and needs Icarus Verilog and Yosys
    #[arg(long)]
    verify: bool,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N", value_parser = seed())]
    seed: Option<u64>,
    /// Threads; the results are the same for any number [default: one a core]
    #[arg(long, value_name = "N", value_parser = threads())]
    threads: Option<u16>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Hits of the TDC's code density, frames of each variant of the error budget, histograms of the accuracy.
const SIZES: [u64; 3] = [1_000_000, 1_000, 30_600];

/// Probe configuration of the waveform, from 8 samples of clk_laser before the first laser edge on.
const SCOPE: &str = "scenario = \"kc705\"\nclock = \"clk_laser\"\ndepth = 1024\nposition = 8\ntrigger = \"start rising\"\n\
    [[probe]]\nname = \"pre_start\"\nsignal = \"pre_start\"\n\
    [[probe]]\nname = \"spad_rst\"\nsignal = \"spad_rst\"\n\
    [[probe]]\nname = \"laser_pulse\"\nsignal = \"vcsel_driver.laser_pulse\"\n\
    [[probe]]\nname = \"start\"\nsignal = \"start\"\n\
    [[probe]]\nname = \"tdc_stop\"\nsignal = \"tdc_stop\"\n\
    [[probe]]\nname = \"hit\"\nsignal = \"tdc.tdc_latch.hit\"\n\
    [[probe]]\nname = \"n\"\nsignal = \"tdc.tdc_decoder.n\"\nradix = \"unsigned\"\n\
    [[probe]]\nname = \"tdc_valid\"\nsignal = \"tdc_valid\"\n\
    [[probe]]\nname = \"tdc_code\"\nsignal = \"tdc_code\"\nradix = \"unsigned\"\n";
/// Samples of it that are shown.
const SAMPLES: usize = 48;

/// Runs the verb, with others' commands through `run_command`.
pub fn run(args: &Args, console: &Console, run_command: RunCommand) -> Result<ExitCode> {
    use_threads(args.threads)?;
    let loaded = args.scenario.load(args.seed)?;
    let setup = Setup::new(loaded.clone())?;
    let mut notes = setup.notes()?;
    notes.extend(notes_of_firmware(&setup));
    let findings = LinkBudget::of(setup.clone());
    notes.extend(findings.eye_safety_notes());
    console.print_notes(&notes)?;
    let _held = FolderLock::take(&args.output)?;
    let words = Words {
        scenario: &args.scenario.scenario,
        set: &args.scenario.set,
        seed: args.seed,
        grid: loaded.scenario.training.grid_options(),
    };
    let parts =
        Parts { quick: args.quick, words, console, run_command, loaded: &loaded, setup: &setup };
    let progress = console.uneven_progress(6, "parts");
    let waveform = made(parts.waveform(), &progress)?;
    let run = made(parts.run(), &progress)?;
    let tdc = made(parts.tdc(), &progress)?;
    let errors = made(parts.errors(), &progress)?;
    let evaluation = made(parts.evaluation(), &progress)?;
    let (verified, passed) = if args.verify {
        parts.verified(&progress)?
    } else {
        (Err("it was not asked for; --verify runs it".to_owned()), true)
    };
    progress.finish_and_clear();
    look_no_more();
    let record = Record::new(&setup, &console.command);
    let trace = waveform.as_ref().ok().map(|trace| wavejson(trace, &setup.name));
    let page = ScenarioPage {
        setup: &setup,
        record: &record,
        notes: notes.iter().map(ToString::to_string).collect(),
        budget: findings.rows(),
        waveform,
        run,
        tdc,
        errors,
        evaluation,
        verified,
        commands: parts.words.by_hand(),
    };
    let mut object = object(args.quick, &findings, &page);
    record.put_into(&mut object, &notes);
    let html = page.html()?;
    let stage = StagedFolder::new(&args.output)?;
    write_bytes(&stage.path().join("report.html"), html)?;
    write_bytes(&stage.path().join("report.json"), format!("{object:#}\n"))?;
    if let Some(trace) = trace {
        write_bytes(&stage.path().join("waveform.json"), format!("{trace}\n"))?;
    }
    stage.commit()?.iter().for_each(|path| console.wrote(path));
    if args.json {
        print_json(&object)?;
    }
    Ok(if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Returns the JSON object; parts that are missing are null.
fn object(quick: bool, findings: &LinkBudget, page: &ScenarioPage) -> Value {
    json!({
        "schema": "tofsim.report/1",
        "quick": quick,
        "budget": findings.object(),
        "run": page.run.as_ref().ok().map(|(run, _)| run),
        "tdc": page.tdc.as_ref().ok().map(|(tdc, _)| tdc),
        "evaluation": page.evaluation.as_ref().ok(),
        "verify": page.verified.as_ref().ok().map(|(verify, _)| verify),
    })
}

/// Keeps an input error as the reason why a part is missing, so that the report goes on to the next one.
fn made<T>(part: Result<T>, progress: &Progress) -> Result<ReportPart<T>> {
    progress.inc(1);
    match part {
        Ok(part) => Ok(Ok(part)),
        Err(Error::Input(why)) => Ok(Err(why.to_string())),
        Err(other) => Err(other),
    }
}

struct Parts<'a> {
    quick: bool,
    words: Words<'a>,
    console: &'a Console,
    run_command: RunCommand,
    loaded: &'a Loaded,
    setup: &'a Setup,
}

impl Parts<'_> {
    fn size(&self, part: usize) -> u64 {
        if self.quick { SIZES[part] / 10 } else { SIZES[part] }
    }

    /// Runs another verb, and returns what `read` finds in the folder of its files.
    fn files<T>(
        &self,
        mut words: Vec<String>,
        more: &[&str],
        read: impl Fn(&Path) -> Result<T>,
    ) -> Result<T> {
        let scratch = ScratchFolder::new()?;
        let folder = scratch.path().join("made");
        words.extend(more.iter().map(|&word| word.to_owned()));
        words.extend(["-o".to_owned(), folder.display().to_string()]);
        let words: Vec<_> = words.iter().map(String::as_str).collect();
        (self.run_command)(&words, self.console)?;
        read(&folder)
    }

    fn waveform(&self) -> Result<Trace> {
        let set_up = AnalyserSetup::parse("report", "set-up", SCOPE)?;
        let stop = stop_signal();
        let seen = captured(self.setup, &set_up, stop.as_deref())?;
        let none = || Input::new("waveform", "no shot begins in the run");
        let seen = seen.ok_or_else(none)?;
        let step_ns = self.setup.cycle().fs() as f64 * 0.5e-6;
        let entries = tofsim::hierarchy::entries(&self.setup.params);
        let signal = |path: &str| {
            let entry = entries.iter().find(|entry| entry.below_top() == path)?;
            Some(entry.signal.clone())
        };
        let probes = set_up.file.probe.iter();
        let signals: Vec<_> = probes.map(|probe| signal(&probe.signal)).collect();
        let mut trace = Trace::of_signals(&seen, &signals, 0..SAMPLES, step_ns);
        trace.marks = vec![(8.0 * step_ns, "laser edge".to_owned())];
        Ok(trace)
    }

    fn run(&self) -> Result<(Value, String)> {
        self.files(self.words.of(&["run"]), &["--waves", "none"], |folder| {
            let histogram = read_text(&folder.join("histogram.svg"))?;
            Ok((read_object(&folder.join("summary.json"))?, histogram))
        })
    }

    fn tdc(&self) -> Result<(Value, Vec<String>)> {
        let setup = self.setup;
        if setup.scenario.tdc.conditions.is_some() {
            let expected = "a chain is characterised under constant conditions";
            return Err(Input::new("tdc.conditions", expected).into());
        }
        let converter = (&setup.params.tdc, setup.disturbance());
        let found = Characterisation::new(converter, self.size(0), setup.scenario.seed);
        let found = TdcFindings { found: &found, setup };
        let pictures = found.plots()?.into_iter().take(3).map(|(_, svg)| svg).collect();
        Ok((found.object(), pictures))
    }

    fn errors(&self) -> Result<(String, String)> {
        let kind = EstimatorKind::in_socket(&self.loaded.scenario);
        let plan = Plan::new(self.loaded, kind)?;
        let stop = stop_signal();
        let budget = plan.measure(self.size(1), stop.as_deref(), &|_| {})?;
        let points = [(self.loaded.scenario.target.distance_m, budget)];
        let budgets = DepthBudgets { key: None, points: &points };
        let svg = budgets.plots()?.into_iter().map(|(_, svg)| svg).collect();
        Ok((svg, budgets.text()))
    }

    fn evaluation(&self) -> Result<Value> {
        let kind = EstimatorKind::in_socket(&self.loaded.scenario).name();
        let rows = self.size(2).to_string();
        let more = ["--estimator", kind, "--check", "2", "--rows", &rows];
        let read = |folder: &Path| read_object(&folder.join("evaluation.json"));
        self.files(self.words.evaluation(), &more, read)
    }

    /// Blocks and cycle counts of the Verilog in rtl_ref, and whether all is well.
    fn verified(&self, progress: &Progress) -> Result<(ReportPart<(Value, Value)>, bool)> {
        let mut words = self.words.of(&["verify", "--scenario"]);
        words.remove(0);
        let words: Vec<_> = words.iter().map(String::as_str).collect();
        let checked = || -> Result<(Value, Value, bool)> {
            let args = verify::Args::of(&words)?;
            let console = self.console.within(Vec::new());
            let (source, blocks) = verify::blocks(&args, &console)?;
            let (counted, counts) = verify::cycle_counts(&args, &console)?;
            let passed =
                blocks.iter().all(BlockReport::is_good) && counts.iter().all(|one| one.holds());
            let blocks = Verified { rtl: &source, simulator: "icarus", blocks: &blocks };
            let counts = CycleCounts { rtl: &counted, counts: &counts };
            Ok((blocks.object(), counts.object(), passed))
        };
        Ok(match made(checked(), progress)? {
            Ok((blocks, counts, passed)) => (Ok((blocks, counts)), passed),
            Err(why) => (Err(why), false),
        })
    }
}
