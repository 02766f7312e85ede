//! Resources of the instrument on two parts.

use std::path::{Path, PathBuf};
use std::time::Duration;

use rayon::prelude::*;
use serde_json::{Map, json};

use tofsim::error::Result;
use tofsim::files::output::write_bytes;
use tofsim::files::staged::ScratchFolder;
use tofsim_rtl::instrument;
use tofsim_rtl::timing::Part;
use tofsim_rtl::timing::resources::resources;
use tofsim_rtl::timing::versions::version;
use tofsim_rtl::verify::Rtl;
use tofsim_rtl::verify::process::{Limits, YOSYS};

use crate::verbs::terminal::stop_signal;

use super::site::Site;
use super::step::Outcome;
use super::verilog::FOLDER;

const FILE: &str = "cost.json";
/// Most that a synthesis may take.
const LIMIT: Duration = Duration::from_secs(1200);

pub fn run(site: &Site) -> Result<Outcome> {
    let (work, folder) = (ScratchFolder::new()?, Path::new(FOLDER));
    let rtl = Rtl::folder(folder)?;
    let stop = stop_signal();
    let limits = Limits { stop: stop.as_deref(), ..Limits::new(LIMIT) };
    let one = |part: Part| {
        let found = resources(&rtl, (instrument::MODULE, part), [folder, work.path()], &limits)?;
        site.talk.detail(format_args!("{}: {} LUTs", part.name(), found.lut));
        Ok((part.name().to_owned(), found))
    };
    let found: Result<Vec<_>> = [Part::Kintex7, Part::Ecp5].into_par_iter().map(one).collect();
    let found = found?;
    let of = |(name, it): &(String, _)| (name.clone(), json!(it));
    let parts: Map<_, _> = found.iter().map(of).collect();
    let maker = version(YOSYS, "-V", work.path())?;
    let result = json!({ "schema": "tofsim.cost/1", "maker": maker, "parts": parts });
    let path = PathBuf::from(FILE);
    write_bytes(&path, format!("{result:#}\n"))?;
    let luts: Vec<_> =
        found.iter().map(|(name, it)| format!("{name} {} LUT, {} FF", it.lut, it.ff)).collect();
    Ok(Outcome { outputs: vec![path], result, passed: true, summary: luts.join("; ") })
}
