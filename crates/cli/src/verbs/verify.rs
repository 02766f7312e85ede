//! `tofsim verify`: holds Verilog to the golden vectors.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use clap::{Args as _, Command, FromArgMatches};
use rayon::prelude::*;

use tofsim::error::{Error, Input, Result};
use tofsim::files::staged::ScratchFolder;
use tofsim_rtl::golden::{BLOCKS, Setting, Spec};
use tofsim_rtl::verify::cycle_counts::{self as count, Count};
use tofsim_rtl::verify::process::Limits;
use tofsim_rtl::verify::task::run_all;
use tofsim_rtl::verify::{
    BlockCheck, BlockReport, Dut, Rtl, RtlMap, Simulator, Task, Verdict, strays,
};

use crate::choice::{self, words};
use crate::report::verification::{CycleCounts, Verified, not_checked, notes, write_junit};
use crate::report::writer::Report;
use crate::text::table::coloured;
use crate::text::wrap::message;

use super::design::{Design, present};
use super::terminal::{Console, stop_signal};
use super::vectors::{From, configured, find};

/// Run Verilog or VHDL against the golden vectors
///
/// Makes the vectors of each block, compiles its bench with your design, runs it, and reports the first difference,
/// with a table of the cycles around it and a waveform of both sides. Without --rtl it checks tofsim's own Verilog,
/// which is in the program. VHDL goes through GHDL's synthesis to Verilog. Simulators and GHDL must be on PATH.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Exit status: 0 all pass, 1 a block differs, 2 none differs, but one could not be checked."
)]
pub struct Args {
    #[command(flatten)]
    design: Design,
    /// Block to check, with all its configurations, or one of these, e.g. tdc.leading or tdc.default; may be
    /// repeated [default: all that the design has]
    #[arg(long, value_name = "BLOCK")]
    block: Vec<String>,
    /// Check the whole firmware with a full frame of the scenario too (alone, unless --block is given)
    #[arg(long)]
    top: bool,
    /// Count cycles in the model and in the RTL, and prove them (Icarus and Yosys), instead of vectors
    #[arg(long, conflicts_with_all = ["block", "top", "map", "registers", "from_power_up", "fail_fast", "junit", "simulator"])]
    cycle_counts: bool,
    /// Simulator
    #[arg(long, value_parser = words(choice::SIMULATOR), default_value = "icarus")]
    simulator: Simulator,
    /// Map file (TOML) with the intended differences of your design: names, polarities, latencies, adapters
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Also compare registers inside the blocks, which must have the names of tofsim's [default for our own]
    #[arg(long, conflicts_with = "map")]
    registers: bool,
    /// Compare from power-up on, not only from the first reset on [default for our own]
    #[arg(long)]
    from_power_up: bool,
    /// Stop at the first mismatch, without a waveform
    #[arg(long)]
    fail_fast: bool,
    /// Limit of the processor time of each compilation and simulation
    #[arg(long, value_name = "SECONDS", default_value_t = 300,
        value_parser = clap::value_parser!(u64).range(1..))]
    time_limit: u64,
    /// Write waveforms of mismatches into this folder
    #[arg(short, long, value_name = "DIR", default_value = "waves/verify")]
    output: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Also write JUnit XML
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    #[command(flatten)]
    from: From,
}

impl Args {
    /// Parses the options of a command line without the verb.
    ///
    /// # Errors
    /// When there are no such options.
    pub fn of(words: &[&str]) -> Result<Args> {
        let command = Args::augment_args(Command::new("verify")).no_binary_name(true);
        let fault = |error| Input::new("verify", error);
        let matches = command.try_get_matches_from(words).map_err(fault)?;
        Ok(Args::from_arg_matches(&matches).map_err(fault)?)
    }
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<ExitCode> {
    let failed = if args.cycle_counts {
        let (rtl, counts) = &cycle_counts(args, console)?;
        Report::without_record(CycleCounts { rtl, counts }).deliver(None, args.json, console)?;
        !counts.iter().all(Count::holds)
    } else {
        let (rtl, blocks) = &blocks(args, console)?;
        let verified = Verified { rtl, simulator: args.simulator.name(), blocks };
        Report::without_record(verified).deliver(None, args.json, console)?;
        console.print_notes(&notes(blocks))?;
        let failed = blocks.iter().any(BlockReport::failed);
        let mut faults = not_checked(blocks);
        let last = if failed { None } else { faults.pop() };
        faults.iter().for_each(|fault| message(format_args!("tofsim: {fault}")));
        if let Some(fault) = last {
            return Err(fault);
        }
        failed
    };
    Ok(ExitCode::from(u8::from(failed)))
}

/// Checks the blocks that are asked for; where the design comes from, and how each came out, be it that it could not
/// be checked.
///
/// # Errors
/// When the sources or the map cannot be read, the simulator is missing, or the user stops everything.
pub fn blocks(args: &Args, console: &Console) -> Result<(String, Vec<BlockReport>)> {
    let map = args.map.as_deref().map(RtlMap::read).transpose()?;
    let work = ScratchFolder::new()?;
    let rtl = args.rtl(&work, console)?;
    args.simulator.check_is_installed()?;
    let stop = stop_signal();
    let limits = args.limits(stop.as_deref());
    let tasks = tasks(args, map.as_ref(), &rtl, console)?;
    let check = BlockCheck {
        dut: Dut { rtl: &rtl, map: map.as_ref(), simulator: args.simulator, limits },
        registers: args.registers || args.design.is_ours(),
        from_power_up: args.from_power_up || args.design.is_ours(),
        first_only: args.fail_fast,
        output: &args.output,
    };
    let over = AtomicBool::new(false);
    let one = |task: &&Task| {
        if over.load(Ordering::Relaxed) {
            let reason = "another differs: --fail-fast".to_owned();
            return Ok(BlockReport::without_run(&task.name, Verdict::NotRun { reason }));
        }
        let report = match check.run(task, &work.path().join(&task.name)) {
            Err(Error::Interrupted) => return Err(Error::Interrupted),
            Err(fault) => {
                let reason = fault.to_string();
                BlockReport::without_run(&task.name, Verdict::NotChecked { reason })
            }
            Ok(report) => report,
        };
        let word = coloured(report.word(), report.is_good(), &std::io::stderr());
        console.note(format_args!("{}: {word}", task.name));
        over.fetch_or(args.fail_fast && report.failed(), Ordering::Relaxed);
        Ok(report)
    };
    let reports = run_all(&tasks, |tasks| tasks.par_iter().map(one).collect())?;

    let simulator = args.simulator.name();
    if let Some(path) = &args.junit {
        write_junit(path, simulator, &reports)?;
        console.wrote(path);
    }
    for wave in reports.iter().filter_map(|report| report.wave.as_ref()) {
        console.wrote_wave(wave);
    }
    Ok((rtl.source, reports))
}

/// Counts cycles in the model and in the design, and proves them; where the design comes from, and each count.
///
/// # Errors
/// When they cannot be counted.
pub fn cycle_counts(args: &Args, console: &Console) -> Result<(String, Vec<Count>)> {
    let work = ScratchFolder::new()?;
    let rtl = args.rtl(&work, console)?;
    let stop = stop_signal();
    let limits = args.limits(stop.as_deref());
    Design::check_for_yosys(&rtl, "--cycle-counts")?;
    let design = count::CountedDesign::of(&args.from.setting()?.setup);
    let counts = count::cycle_counts(&rtl, &design, &limits, |count: &Count| {
        let word = if count.holds() { "holds" } else { "fails" };
        let word = coloured(word, count.holds(), &std::io::stderr());
        console.note(format_args!("{}: {word}", count.what));
    })?;
    Ok((rtl.source, counts))
}

impl Args {
    /// The design; our own is put into `work`.
    fn rtl(&self, work: &ScratchFolder, console: &Console) -> Result<Rtl> {
        strays::end();
        if self.design.is_ours() { Rtl::own(work.path()) } else { self.design.read(console) }
    }

    fn limits<'a>(&self, stop: Option<&'a AtomicBool>) -> Limits<'a> {
        Limits { stop, ..Limits::new(Duration::from_secs(self.time_limit)) }
    }
}

/// The blocks that are asked for and all that they can be, then the whole.
fn tasks(args: &Args, map: Option<&RtlMap>, rtl: &Rtl, console: &Console) -> Result<Vec<Task>> {
    let setting = args.from.setting()?;
    let all = |spec| (spec, None);
    let chosen: Vec<_> = match (args.block.as_slice(), args.top) {
        ([], true) => Vec::new(),
        ([], false) => every(map, rtl, console)?.into_iter().map(all).collect(),
        (names, _) => {
            let named = names.iter().map(|name| configured(name, &setting, "--block"));
            named.collect::<Result<_>>()?
        }
    };
    let mut tasks = Vec::new();
    for (spec, configuration) in chosen {
        tasks.extend(Task::every(spec, configuration, &setting, map)?);
    }
    if args.top {
        let setting = Setting { as_configured: true, ..setting };
        let task = Task::new(find("tof_top", "--top")?, &setting, map);
        tasks.push(Task { name: format!("tof_top.{}", setting.setup.name), ..task });
    }
    Ok(tasks)
}

/// All blocks that the design has, or the map names.
fn every(map: Option<&RtlMap>, rtl: &Rtl, console: &Console) -> Result<Vec<&'static Spec>> {
    let has = |spec: &Spec| {
        let named = map.and_then(|map| map.block.get(spec.name));
        named.is_some_and(|block| block.module.is_some()) || rtl.has(spec.name)
    };
    let or = ", or a map with their names";
    present(BLOCKS.iter(), has, |spec| spec.name, (rtl, or, "checked"), console)
}
