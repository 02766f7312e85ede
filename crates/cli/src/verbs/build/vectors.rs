//! Golden vectors of every block.

use serde_json::json;

use tofsim::error::Result;
use tofsim::files::folder;
use tofsim_rtl::golden::BLOCKS;

use super::site::Site;
use super::step::Outcome;

/// Clock cycles of each block where all is to be quick.
pub const QUICK_CYCLES: &str = "2000";
const FOLDER: &str = "vectors";

pub fn run(site: &Site) -> Result<Outcome> {
    let mut words = vec!["vectors", "all", "--scenario", site.scenario(), "-o", FOLDER];
    words.extend(if site.quick { &["--cycles", QUICK_CYCLES][..] } else { &[] });
    site.run(&words)?;
    let outputs = folder::files_below(FOLDER.as_ref())?;
    let summary = format!("{} blocks in {FOLDER}/", BLOCKS.len());
    let result = json!({ "blocks": BLOCKS.len() });
    Ok(Outcome { outputs, result, passed: true, summary })
}
