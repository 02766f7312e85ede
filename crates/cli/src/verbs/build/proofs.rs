//! The cycle counts, and the Verilog beside the model.

use std::path::PathBuf;

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::files::output::write_bytes;
use tofsim_rtl::instrument;
use tofsim_rtl::verify::BlockReport;
use tofsim_rtl::verify::cycle_counts::Count;

use crate::report::verification::{CycleCounts, Verified};
use crate::report::writer::Findings as _;
use crate::verbs::verify;

use super::site::Site;
use super::step::Outcome;
use super::vectors::QUICK_CYCLES;
use super::verilog::FOLDER;

/// Most shots of the frame that the whole is held to.
const SHOTS: u64 = 300;

pub fn cycles(site: &Site) -> Result<Outcome> {
    let words = ["--cycle-counts", "--rtl", FOLDER, "--scenario", site.scenario()];
    let (args, talk) = site.verify(&words)?;
    let (source, counts) = verify::cycle_counts(&args, &talk)?;
    let held = counts.iter().filter(|count| count.holds()).count();
    let summary = format!("{held} of {} counts proven", counts.len());
    let passed = counts.iter().all(Count::holds);
    written("cycles.json", CycleCounts { rtl: &source, counts: &counts }.object(), passed, summary)
}

pub fn verify(site: &Site) -> Result<Outcome> {
    let mut words =
        vec!["--rtl", FOLDER, "--scenario", site.scenario(), "--registers", "--from-power-up"];
    words.extend(if site.quick { &["--cycles", QUICK_CYCLES][..] } else { &[] });
    let (args, talk) = site.verify(&words)?;
    let (source, mut reports) = verify::blocks(&args, &talk)?;
    let map = PathBuf::from(FOLDER).join(instrument::MAP).display().to_string();
    let shots = SHOTS.min(site.loaded.scenario.firmware.shots_per_frame);
    let shots = format!("firmware.shots_per_frame={shots}");
    let whole =
        ["--rtl", FOLDER, "--map", &map, "--top", "--scenario", site.scenario(), "-s", &shots];
    let (args, talk) = site.verify(&whole)?;
    reports.extend(
        verify::blocks(&args, &talk)?.1.into_iter().map(|report| BlockReport {
            name: format!("{}, a frame", instrument::MODULE),
            ..report
        }),
    );
    let failed = reports.iter().filter(|report| report.failed()).count();
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
