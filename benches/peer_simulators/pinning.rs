//! Pinning of this process and its children to one core.

use std::num::NonZero;
use std::process::{self, Command};
use std::thread;

use crate::Result;
use crate::run;

/// Pins the process to `core` or the last core, and returns a description.
pub fn pin(core: Option<usize>) -> Result<String> {
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let core = core.unwrap_or(cores - 1);
    if Command::new("taskset").arg("--version").output().is_err() {
        return Ok("not pinned to a core: taskset is missing (install util-linux)".into());
    }
    let process = process::id().to_string();
    run::stdout(Command::new("taskset").args(["-cp", &core.to_string(), &process]))?;
    Ok(format!("pinned to core {core} of {cores}"))
}
