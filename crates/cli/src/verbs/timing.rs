//! `tofsim timing`: how fast a design's blocks can be clocked.

use std::collections::BTreeMap;
use std::path::PathBuf;
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
use tofsim_rtl::verify::{strays, yosys};

use crate::choice::{self, words};
use crate::report::timing as report;

use super::design::Design;
use super::terminal::{Talk, print, stop_signal};

/// Measure and estimate how fast Verilog can be clocked
///
/// Synthesises each block between registers (Yosys). For an ECP5 of speed grade 8, nextpnr places and
/// routes it and measures every clock; for a Kintex-7 there is an estimate from the netlist: levels, and
/// the longest path if each routed net takes 0.3, 0.6 or 0.9 ns. Both name the critical path. Without --rtl
/// it takes tofsim's own Verilog, which is in the program. The tools are looked for on PATH.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Exit status: 0 every measured clock is fast enough (125 and 250 MHz), 1 one is \
    not, 2 it could not be measured."
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
    /// How many placements to try, with the seeds from 1 on
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100))]
    seeds: u32,
    /// Most that one run of a tool may take
    #[arg(long, value_name = "SECONDS", default_value_t = 1200,
        value_parser = clap::value_parser!(u64).range(1..))]
    time_limit: u64,
    /// Take what this file has of the same netlists from it, and write all that was timed into it
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the verb.
pub fn run(args: &Args, talk: &Talk) -> Result<ExitCode> {
    strays::end();
    let work = ScratchFolder::new()?;
    let folder = match args.design.is_ours() {
        true => work.path().to_owned(),
        false => std::env::current_dir().map_err(Error::io(".".as_ref(), "read"))?,
    };
    let rtl = match args.design.is_ours() {
        true => timing::own(work.path(), &Setup::new(scenario::load(DEFAULT, &[])?)?)?,
        false => args.design.read(talk)?,
    };
    if let Some(path) = yosys::unread(&rtl) {
        let expected =
            "expected Verilog sources only, without libraries: Yosys reads no others here";
        return Err(Input::new("timing", expected).value(path.display().to_string()).into());
    }
    let blocks = wanted(args, &rtl, talk)?;
    let stop = stop_signal();
    let limits =
        Limits { stop: stop.as_deref(), ..Limits::new(Duration::from_secs(args.time_limit)) };
    let design = timing::Design { rtl: &rtl, folder: &folder, work: work.path(), limits };
    let is_wanted = |part| args.part.is_none_or(|only| only == part);
    let place = nextpnr::installed().filter(|_| is_wanted(timing::Part::Ecp5));
    if place.is_none() && args.part == Some(timing::Part::Ecp5) {
        let expected = format!("not found on PATH; install it: {}", nextpnr::HOW_TO_INSTALL);
        return Err(Input::new("nextpnr-ecp5", expected).into());
    }
    if place.is_none() && args.part.is_none() {
        talk.note(format_args!(
            "nextpnr-ecp5: not found on PATH, so nothing is measured for an ECP5; install it: {}",
            nextpnr::HOW_TO_INSTALL
        ));
    }
    let known = args.record.as_deref().map(Record::read).transpose()?.flatten().unwrap_or_default();
    let mut tools = BTreeMap::from([("yosys".to_owned(), version(YOSYS, "-V", work.path())?)]);
    if let Some(tool) = place {
        tools.insert("nextpnr".to_owned(), version(tool, "--version", work.path())?);
    }
    let known = if known.tools == tools { known } else { Record::default() };
    let one = |block: &&'static TimedBlock| {
        let ecp5 = match place {
            Some(tool) => Some(measured(&design, block, tool, args.seeds, &known, talk)?),
            None => None,
        };
        let is_kintex7 = is_wanted(timing::Part::Kintex7);
        let kintex7 = is_kintex7.then(|| timing::estimate(&design, block)).transpose()?;
        talk.note(format_args!("{}: timed", block.name));
        Ok((block.name.to_owned(), BlockTiming { ecp5, kintex7 }))
    };
    let timed: Result<BTreeMap<_, _>> = blocks.par_iter().map(one).collect();
    let record = Record { tools, blocks: timed? };
    if let Some(path) = &args.record {
        let mut all = Record { tools: record.tools.clone(), blocks: known.blocks };
        all.blocks.extend(record.blocks.clone());
        all.write(path)?;
        talk.wrote(path);
    }
    match args.json {
        true => print(&format!("{:#}\n", report::json(&rtl.source, &record)))?,
        false => talk.report(&report::text(&record))?,
    }
    let measured = || record.blocks.values().filter_map(|block| block.ecp5.as_ref());
    Ok(ExitCode::from(u8::from(!measured().all(Measurement::closes))))
}

/// What place-and-route of a block comes to: from a record if that has the same netlist.
fn measured(
    design: &timing::Design,
    block: &TimedBlock,
    tool: Tool,
    seeds: u32,
    known: &Record,
    talk: &Talk,
) -> Result<Measurement> {
    let before = known.blocks.get(block.name).and_then(|block| block.ecp5.as_ref());
    let mut placed = 0;
    let measurement = timing::measure(design, block, tool, seeds, before, |seed| {
        placed = seed;
        talk.detail(format_args!("{}: seed {seed} placed and routed", block.name));
    })?;
    if placed == 0 {
        talk.note(format_args!("{}: the same netlist as in the record", block.name));
    }
    Ok(measurement)
}

/// The blocks that are asked for, or all that the design has.
fn wanted(
    args: &Args,
    rtl: &tofsim_rtl::verify::Rtl,
    talk: &Talk,
) -> Result<Vec<&'static TimedBlock>> {
    if !args.block.is_empty() {
        return args.block.iter().map(|name| TimedBlock::find(name)).collect();
    }
    let has = |block: &&TimedBlock| block.modules.iter().all(|module| rtl.has(module));
    let usual = BLOCKS.iter().filter(|block| block.usual);
    let (there, missing): (Vec<_>, Vec<_>) = usual.partition(has);
    let missing: Vec<_> = missing.iter().map(|block| block.name).collect();
    let missing = missing.join(", ");
    if there.is_empty() {
        let expected = format!("expected one of the modules {missing}");
        return Err(Input::new(&rtl.source, expected).into());
    }
    if !missing.is_empty() {
        talk.note(format_args!(
            "{}: not timed, because it has no such module: {missing}",
            rtl.source
        ));
    }
    Ok(there)
}
