//! Icarus Verilog with the sources in `rtl_ref`.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::compilers::Workshop;
use crate::contender::{Call, Contender, FEW_SHOTS, SHOTS, Work};
use crate::sources::{Source, Sources};
use crate::{Result, run};

/// Options of every build.
pub const OPTIONS: &str = "-g2012 -s bench";

/// Builds the peer; with `quick`, for frames of few shots.
pub fn contender(workshop: &Workshop, quick: bool) -> Result<Contender> {
    let shots = if quick { FEW_SHOTS } else { workshop.shots };
    let mut sources = Sources::Reference.modules(workshop.root)?;
    sources.push(Source::read(&workshop.root.join("benches/peer_simulators/icarus.v"))?);
    let parameter = format!("-Pbench.ShotsPerFrame={shots}");
    let build = |folder: &Path, verilog: &[PathBuf]| {
        let mut command = Command::new("iverilog");
        command.args(OPTIONS.split_whitespace()).arg(&parameter).current_dir(workshop.root);
        command.arg("-o").arg(folder.join("bench.vvp")).args(verilog);
        run::stdout(&mut command).map(drop)
    };
    let folder = workshop.cache.get("icarus", &sources, &[OPTIONS, &parameter], build)?;
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
