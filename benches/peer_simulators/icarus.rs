//! Icarus Verilog with the sources in `rtl_ref`.

use std::path::Path;
use std::process::Command;

use crate::builds::Cache;
use crate::compilers::Sources;
use crate::contender::{Call, Contender, FEW_SHOTS, SHOTS, Work};
use crate::{Result, run};

/// Options of every build.
pub const OPTIONS: &str = "-g2012 -s bench";

/// Builds the peer; with `quick`, for frames of few shots.
pub fn contender(root: &Path, cache: &Cache, quick: bool) -> Result<Contender> {
    let shots = if quick { FEW_SHOTS } else { SHOTS };
    let bench = root.join("benches/peer_simulators");
    let mut sources = Sources::Reference.files(root)?;
    sources.push(bench.join("icarus.v"));
    let parameter = format!("-Pbench.ShotsPerFrame={shots}");
    let build = |folder: &Path| {
        let mut command = Command::new("iverilog");
        command.args(OPTIONS.split_whitespace()).arg(&parameter).current_dir(root);
        command.arg("-o").arg(folder.join("bench.vvp")).args(&sources);
        run::stdout(&mut command).map(drop)
    };
    let flags = [OPTIONS.to_string(), parameter.clone()];
    let folder = cache.get("icarus", &sources, &flags, build)?;
    Ok(Contender {
        simulator: "icarus",
        variant: "rtl_ref",
        work: Work::Cycle,
        call: Call::Vvp(folder.join("bench.vvp")),
        frames: if shots == SHOTS { 1 } else { 3 },
        shots,
        is_slow: shots == SHOTS,
    })
}
