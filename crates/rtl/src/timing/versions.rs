//! Versions of the tools.

use std::path::Path;
use std::time::Duration;

use tofsim::error::Result;

use crate::verify::process::{Limits, Tool};

/// Returns the version of a tool, without the date and place of its making, such as `Yosys 0.23`.
///
/// # Errors
/// When it is missing or cannot be run.
pub fn version(tool: Tool, option: &str, folder: &Path) -> Result<String> {
    let limits = Limits::new(Duration::from_secs(300));
    let output = tool.run(folder, [option], &limits)?.output;
    let line = output.lines().find(|line| line.contains("Version ") || line.starts_with("Yosys "));
    let line = line.unwrap_or_default();
    let line =
        line.split_once("(Version ").map_or(line, |(_, version)| version.trim_end_matches(')'));
    Ok(line.split(" (").next().unwrap_or(line).to_owned())
}
