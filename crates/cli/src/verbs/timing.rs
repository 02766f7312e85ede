//! `tofsim timing`: how fast a design's blocks can be clocked.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use rayon::prelude::*;

use tofsim::error::{Error, Input, Result};
use tofsim::files::staged::ScratchFolder;
use tofsim::scenario::{self, DEFAULT};
use tofsim::sim::setup::Setup;
use tofsim_rtl::timing::record::{BlockTiming, Record};
use tofsim_rtl::timing::versions::version;
use tofsim_rtl::timing::{self, BLOCKS, Measurement, TimedBlock, nextpnr};
use tofsim_rtl::verify::process::{Limits, Tool, YOSYS};
use tofsim_rtl::verify::{Rtl, strays};

use crate::choice::{self, words};
use crate::report::timing::DesignTiming;
use crate::report::writer::Report;

use super::design::{Design, present};
use super::terminal::{Console, stop_signal};

/// Measure or estimate the clock frequency of Verilog
///
/// Synthesises each block between registers (Yosys). For an ECP5 of speed grade 8, nextpnr places and routes it and
/// measures every clock; for a Kintex-7 there is an estimate from the netlist: levels, and the longest path if each
/// routed net takes 0.3, 0.6 or 0.9 ns. Both name the critical path. Without --rtl it takes tofsim's own Verilog,
/// which is in the program. The tools must be on PATH.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Exit status: 0 every measured clock meets 125 or 250 MHz, 1 one does not, 2 not measured."
)]
pub struct Args {
    #[command(flatten)]
    design: Design,
    /// Block to time; may be repeated [default: all that the design has, but not tof_top]
    #[arg(long, value_name = "BLOCK")]
    block: Vec<String>,
    /// Part [default: both]
    #[arg(long, value_parser = words(choice::PART))]
    part: Option<timing::Part>,
    /// Number of placements, with seeds from 1 on
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100))]
    seeds: u32,
    /// Limit of the processor time of each run of a tool
    #[arg(long, value_name = "SECONDS", default_value_t = 1200,
        value_parser = clap::value_parser!(u64).range(1..))]
    time_limit: u64,
    /// Reuse the results in this file for netlists that have not changed, and write all results to it
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<ExitCode> {
    strays::end();
    let work = ScratchFolder::new()?;
    let (folder, rtl) = design(args, work.path(), console)?;
    let blocks = wanted(args, &rtl, console)?;
    let stop = stop_signal();
    let limits =
        Limits { stop: stop.as_deref(), ..Limits::new(Duration::from_secs(args.time_limit)) };
    let design = timing::TimedDesign { rtl: &rtl, folder: &folder, work: work.path(), limits };
    let place = placer(args, console)?;
    let known = args.record.as_deref().map(Record::read).transpose()?.flatten().unwrap_or_default();
    let mut tools = BTreeMap::from([("yosys".to_owned(), version(YOSYS, "-V", work.path())?)]);
    if let Some(tool) = place {
        let version = version(tool, "--version", work.path())?;
        let options = nextpnr::LONG_CHAIN_PLACER;
        tools.insert("nextpnr".to_owned(), format!("{version}, long chains {options}"));
    }
    let known = if known.tools == tools { known } else { Record::default() };
    let one = |block: &&'static TimedBlock| {
        let ecp5 = match place {
            Some(tool) => Some(measured(&design, block, tool, args.seeds, &known, console)?),
            None => None,
        };
        let kintex7 = args
            .wants(timing::Part::Kintex7)
            .then(|| timing::estimate(&design, block))
            .transpose()?;
        console.note(format_args!("{}: timed", block.name));
        Ok((block.name.to_owned(), BlockTiming { ecp5, kintex7 }))
    };
    let timed: Result<BTreeMap<_, _>> = blocks.par_iter().map(one).collect();
    let record = Record { tools, blocks: timed? };
    if let Some(path) = &args.record {
        let mut all = Record { tools: record.tools.clone(), blocks: known.blocks };
        all.blocks.extend(record.blocks.clone());
        all.write(path)?;
        console.wrote(path);
    }
    let timing = DesignTiming { rtl: &rtl.source, record: &record };
    Report::without_record(timing).deliver(None, args.json, console)?;
    let measured = || record.blocks.values().filter_map(|block| block.ecp5.as_ref());
    Ok(ExitCode::from(u8::from(!measured().all(Measurement::closes))))
}

impl Args {
    fn wants(&self, part: timing::Part) -> bool {
        self.part.is_none_or(|only| only == part)
    }
}

/// Reads the design; its own Verilog goes into `work`. Returns the folder of its sources too.
fn design(args: &Args, work: &Path, console: &Console) -> Result<(PathBuf, Rtl)> {
    let (folder, rtl) = if args.design.is_ours() {
        let setup = Setup::new(scenario::load(DEFAULT, &[])?)?;
        (work.to_owned(), timing::own(work, &setup)?)
    } else {
        let here = std::env::current_dir().map_err(Error::io(".".as_ref(), "read"))?;
        (here, args.design.read(console)?)
    };
    Design::check_for_yosys(&rtl, "timing")?;
    Ok((folder, rtl))
}

/// Finds the tool that places and routes, if it is wanted; a note says that it is missing.
fn placer(args: &Args, console: &Console) -> Result<Option<Tool>> {
    let place = nextpnr::installed().filter(|_| args.wants(timing::Part::Ecp5));
    if place.is_none() && args.part == Some(timing::Part::Ecp5) {
        let expected = format!("not found on PATH; install it: {}", nextpnr::HOW_TO_INSTALL);
        return Err(Input::new("nextpnr-ecp5", expected).into());
    }
    if place.is_none() && args.part.is_none() {
        console.note(format_args!(
            "nextpnr-ecp5: not found on PATH, so nothing is measured for an ECP5; install it: {}",
            nextpnr::HOW_TO_INSTALL
        ));
    }
    Ok(place)
}

/// Returns the place-and-route result of a block: from a record if that has the same netlist.
fn measured(
    design: &timing::TimedDesign,
    block: &TimedBlock,
    tool: Tool,
    seeds: u32,
    known: &Record,
    console: &Console,
) -> Result<Measurement> {
    let before = known.blocks.get(block.name).and_then(|block| block.ecp5.as_ref());
    let mut placed = 0;
    let measurement = timing::measure(design, block, tool, seeds, before, |seed| {
        placed = seed;
        console.detail(format_args!("{}: seed {seed} placed and routed", block.name));
    })?;
    if placed == 0 {
        console.note(format_args!("{}: the same netlist as in the record", block.name));
    }
    Ok(measurement)
}

/// The blocks that are asked for, or all that the design has.
fn wanted(args: &Args, rtl: &Rtl, console: &Console) -> Result<Vec<&'static TimedBlock>> {
    if !args.block.is_empty() {
        return args.block.iter().map(|name| TimedBlock::find(name)).collect();
    }
    let has = |block: &TimedBlock| block.modules.iter().all(|module| rtl.has(module));
    let usual = BLOCKS.iter().filter(|block| block.usual);
    present(usual, has, |block| block.name, (rtl, "", "timed"), console)
}
