//! `tofsim build`: everything of an instrument from one file.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use serde_json::json;

use tofsim::error::{Error, Input, Result};
use tofsim::files::folder::FolderLock;
use tofsim_rtl::verify::strays;

use crate::choice::{threads, words};

use super::draws::use_threads;
use super::interrupt::look_no_more;
use super::terminal::{Console, RunCommand, print_json};

mod design;
mod files;
mod journal;
mod measured;
mod network;
mod page;
mod site;
mod step;

use journal::{Journal, StepRecord};
use site::Site;
use step::{Outcome, Step};

/// Build an instrument: network, Verilog, proofs, accuracy, cost and a report, from one scenario file
///
/// Each step does the same as its own command. A step is skipped if its inputs, version and outputs are those of an
/// earlier build, so that an interrupted build is resumed. DIR/report.html is a self-contained page.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim build mine.toml -o mine           all steps\n  \
    tofsim build mine.toml -o mine --quick   in a minute or two, poor accuracy\n  \
    tofsim build mine.toml -o mine --steps network,accuracy,report\n\n\
    Exit status: 0 all done and passed, 1 a step failed or found a fault, 2 usage or input error.")]
pub struct Args {
    /// Scenario file, or the name of a built-in scenario
    #[arg(value_name = "INSTRUMENT")]
    instrument: String,
    /// Output folder, in which the commands of the report are run
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Run only these steps, separated by commas
    #[arg(long, value_parser = words(&Step::CHOICES), value_delimiter = ',')]
    steps: Vec<Step>,
    /// Train for seconds (poor accuracy), with short vectors and few histograms
    #[arg(long)]
    quick: bool,
    /// Repeat all steps
    #[arg(long)]
    force: bool,
    /// Threads; the results are the same for any number [default: one a core]
    #[arg(long, value_name = "N", value_parser = threads())]
    threads: Option<u16>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the verb, with others' commands through `run_command`; the status says whether all was done and passed.
pub fn run(args: &Args, console: &Console, run_command: RunCommand) -> Result<ExitCode> {
    let instrument = files::InstrumentFiles::read(&args.instrument)?;
    let site = Site::new(&instrument, args.quick, console, run_command)?;
    console.print_notes(&site.notes)?;
    instrument.check_folder(&args.output)?;
    let _held = FolderLock::take(&args.output)?;
    use_threads(args.threads)?;
    strays::end();
    // What the steps record of themselves is the same wherever the folder is.
    std::env::set_current_dir(&args.output).map_err(Error::io(&args.output, "open"))?;
    instrument.write(Path::new("."))?;
    let journal = Journal::read()?;
    let mut build = Build { site, journal, args, console };
    let asked = if args.steps.is_empty() { Step::all().to_vec() } else { args.steps.clone() };
    for step in Step::all().into_iter().filter(|step| asked.contains(step)) {
        build.take(step)?;
    }
    let Build { journal, .. } = build;
    let bad: Vec<_> = asked.iter().filter(|step| !journal.has_passed(**step)).collect();
    let passed = bad.is_empty();
    if args.json {
        let mut report = json!(journal);
        report["passed"] = json!(passed);
        print_json(&report)?;
    } else {
        console.report(&summary(&args.output, &journal, &asked))?;
    }
    Ok(if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// A line for each step.
fn summary(folder: &Path, journal: &Journal, asked: &[Step]) -> String {
    let line = |step: &Step| {
        let record = journal.steps.get(step.name());
        let how = record.map_or_else(|| "not done".to_owned(), |record| record.summary.clone());
        format!(" {:<12} {how}\n", step.name())
    };
    let lines: String = asked.iter().map(line).collect();
    if asked.contains(&Step::Report) && journal.has_passed(Step::Report) {
        format!("{lines}\n{} is the report\n", folder.join(page::FILE).display())
    } else {
        lines
    }
}

/// A build under way, in its folder.
struct Build<'a> {
    site: Site<'a>,
    journal: Journal,
    args: &'a Args,
    console: &'a Console,
}

impl Build<'_> {
    /// Does a step, unless it has been done.
    fn take(&mut self, step: Step) -> Result<()> {
        for need in step.needs() {
            if !self.journal.is_whole(need) {
                let expected = format!(
                    "{step} needs {need}, which is not there: add it, or leave --steps out"
                );
                if step != Step::Report && self.journal.missing(need).is_none() {
                    return Err(Input::new("--steps", expected).value(step).into());
                }
            }
        }
        let lacking = step.tools().iter().find(|tool| !tool.is_installed());
        if let Some(tool) = lacking {
            let record = StepRecord::without(tool);
            self.console.note(format_args!("{step}: {}", record.summary));
            return self.journal.put(step, record);
        }
        let input = self.site.input(step, &self.journal);
        if !self.args.force && self.journal.is_done(step, &input) {
            self.console.note(format_args!("{step}: as before"));
            return Ok(());
        }
        self.console.note(format_args!("{step}: {}", step.about()));
        let began = Instant::now();
        let site = &self.site;
        let outcome = match step {
            Step::Network => network::run(site, self.args.force),
            Step::Verilog => design::verilog(site),
            Step::Constraints => design::constraints(site),
            Step::Vectors => design::vectors(site),
            Step::Cycles => design::cycles(site),
            Step::Verify => design::verify(site),
            Step::Frame => measured::frame(site),
            Step::Accuracy => measured::accuracy(site),
            Step::Cost => design::cost(site),
            Step::Report => page::run(site, &self.journal),
        };
        look_no_more();
        let Outcome { outputs, result, passed, summary } = outcome?;
        let record = StepRecord::done(input, &outputs, result, passed, summary)?;
        self.console.note(format_args!(
            "{step}: {} ({:.1} s)",
            record.summary,
            began.elapsed().as_secs_f64()
        ));
        self.journal.put(step, record)
    }
}
