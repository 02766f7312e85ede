//! The Verilog with its parameters set, and the constraints.

use std::path::{Path, PathBuf};

use serde_json::json;

use tofsim::error::Result;
use tofsim::files::output::write_bytes;
use tofsim::files::staged::StagedFolder;
use tofsim_rtl::instrument;

use super::site::Site;
use super::step::Outcome;

/// The folder of the design.
pub const FOLDER: &str = "rtl";

pub fn run(site: &Site) -> Result<Outcome> {
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
