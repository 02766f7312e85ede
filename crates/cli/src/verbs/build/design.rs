//! Steps about the design: Verilog, constraints, golden vectors, the Verilog held to the model, cycle counts, resources.

use std::path::{Path, PathBuf};
use std::time::Duration;

use rayon::prelude::*;
use serde_json::{Map, Value, json};

use tofsim::error::Result;
use tofsim::files::folder;
use tofsim::files::output::write_bytes;
use tofsim::files::staged::{ScratchFolder, StagedFolder};
use tofsim_rtl::golden::BLOCKS;
use tofsim_rtl::instrument;
use tofsim_rtl::timing::Part;
use tofsim_rtl::timing::resources::resources;
use tofsim_rtl::timing::versions::version;
use tofsim_rtl::verify::cycle_counts::Count;
use tofsim_rtl::verify::process::{Limits, YOSYS};
use tofsim_rtl::verify::{BlockReport, Rtl};

use crate::report::verification::{CycleCounts, Verified};
use crate::report::writer::Findings as _;
use crate::verbs::terminal::stop_signal;
use crate::verbs::verify;

use super::site::Site;
use super::step::Outcome;

/// The folder of the design.
const FOLDER: &str = "rtl";

pub fn verilog(site: &Site) -> Result<Outcome> {
    let files = instrument::verilog(&site.with_network()?);
    let stage = StagedFolder::new(Path::new(FOLDER))?;
    for (name, text) in &files {
        write_bytes(&stage.path().join(name), text)?;
    }
    let outputs = stage.commit()?;
    let modules = files.iter().filter(|(name, _)| name.ends_with(".v")).count();
    let summary = format!("{modules} modules and {} ROMs in {FOLDER}/", files.len() - modules - 1);
    let result = json!({ "modules": modules, "top": instrument::MODULE });
    Ok(Outcome { outputs, result, passed: true, summary })
}

pub fn constraints(site: &Site) -> Result<Outcome> {
    let pll = &site.setup.scenario.pll;
    let ending = instrument::constraints_ending(pll.part);
    let path = PathBuf::from(format!("constraints.{ending}"));
    write_bytes(&path, instrument::constraints(&site.setup))?;
    let mhz = pll.clk_sys_mhz();
    let summary = format!("{}: clk_sys {mhz} MHz, clk_laser {} MHz", path.display(), 2.0 * mhz);
    let result = json!({ "file": path });
    Ok(Outcome { outputs: vec![path], result, passed: true, summary })
}

/// Clock cycles of each block where all is to be quick.
const QUICK_CYCLES: &str = "2000";
const VECTORS: &str = "vectors";

pub fn vectors(site: &Site) -> Result<Outcome> {
    let mut words = vec!["vectors", "all", "--scenario", site.scenario(), "-o", VECTORS];
    words.extend(if site.quick { &["--cycles", QUICK_CYCLES][..] } else { &[] });
    site.run(&words)?;
    let outputs = folder::files_below(VECTORS.as_ref())?;
    let summary = format!("{} blocks in {VECTORS}/", BLOCKS.len());
    let result = json!({ "blocks": BLOCKS.len() });
    Ok(Outcome { outputs, result, passed: true, summary })
}

/// Most shots of the frame that the whole is held to.
const SHOTS: u64 = 300;

pub fn cycles(site: &Site) -> Result<Outcome> {
    let words = ["--cycle-counts", "--rtl", FOLDER, "--scenario", site.scenario()];
    let (args, console) = site.verify(&words)?;
    let (source, counts) = verify::cycle_counts(&args, &console)?;
    let held = counts.iter().filter(|count| count.holds()).count();
    let summary = format!("{held} of {} counts proven", counts.len());
    let passed = counts.iter().all(Count::holds);
    written("cycles.json", CycleCounts { rtl: &source, counts: &counts }.object(), passed, summary)
}

pub fn verify(site: &Site) -> Result<Outcome> {
    let mut words =
        vec!["--rtl", FOLDER, "--scenario", site.scenario(), "--registers", "--from-power-up"];
    words.extend(if site.quick { &["--cycles", QUICK_CYCLES][..] } else { &[] });
    let (args, console) = site.verify(&words)?;
    let (source, mut reports) = verify::blocks(&args, &console)?;
    let map = PathBuf::from(FOLDER).join(instrument::MAP).display().to_string();
    let shots = SHOTS.min(site.loaded.scenario.firmware.shots_per_frame);
    let shots = format!("firmware.shots_per_frame={shots}");
    let whole =
        ["--rtl", FOLDER, "--map", &map, "--top", "--scenario", site.scenario(), "-s", &shots];
    let (args, console) = site.verify(&whole)?;
    reports.extend(
        verify::blocks(&args, &console)?.1.into_iter().map(|report| BlockReport {
            name: format!("{}, a frame", instrument::MODULE),
            ..report
        }),
    );
    let failed = reports.iter().filter(|report| !report.is_good()).count();
    let cycles: usize = reports.iter().map(|report| report.cycles).sum();
    let summary =
        format!("{} of {} benches pass, {cycles} cycles", reports.len() - failed, reports.len());
    let verified = Verified { rtl: &source, simulator: "icarus", blocks: &reports };
    written("verify.json", verified.object(), failed == 0, summary)
}

fn written(name: &str, result: Value, passed: bool, summary: String) -> Result<Outcome> {
    let path = PathBuf::from(name);
    write_bytes(&path, format!("{:#}\n", json!(result)))?;
    Ok(Outcome { outputs: vec![path], result, passed, summary })
}

const COST: &str = "cost.json";
/// Most that a synthesis may take.
const LIMIT: Duration = Duration::from_secs(1200);

pub fn cost(site: &Site) -> Result<Outcome> {
    let (work, folder) = (ScratchFolder::new()?, Path::new(FOLDER));
    let rtl = Rtl::folder(folder)?;
    let stop = stop_signal();
    let limits = Limits { stop: stop.as_deref(), ..Limits::new(LIMIT) };
    let one = |part: Part| {
        let found = resources(&rtl, (instrument::MODULE, part), [folder, work.path()], &limits)?;
        site.console.detail(format_args!("{}: {} LUTs", part.name(), found.lut));
        Ok((part.name().to_owned(), found))
    };
    let found: Result<Vec<_>> = [Part::Kintex7, Part::Ecp5].into_par_iter().map(one).collect();
    let found = found?;
    let of = |(name, it): &(String, _)| (name.clone(), json!(it));
    let parts: Map<_, _> = found.iter().map(of).collect();
    let maker = version(YOSYS, "-V", work.path())?;
    let result = json!({ "schema": "tofsim.cost/1", "maker": maker, "parts": parts });
    let path = PathBuf::from(COST);
    write_bytes(&path, format!("{result:#}\n"))?;
    let luts: Vec<_> =
        found.iter().map(|(name, it)| format!("{name} {} LUT, {} FF", it.lut, it.ff)).collect();
    Ok(Outcome { outputs: vec![path], result, passed: true, summary: luts.join("; ") })
}
