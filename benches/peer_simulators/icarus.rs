//! Icarus Verilog, with the sources as they are and with the tuned ones.

use std::path::Path;
use std::process::Command;

use crate::builds::Cache;
use crate::compilers::Sources;
use crate::contender::{Call, Contender, FEW_SHOTS, SHOTS, Work};
use crate::{Result, run};

/// Options of every build.
pub const OPTIONS: &str = "-g2012 -s bench";

/// Builds both; in a hurry with frames of few shots and without waveforms.
pub fn contenders(root: &Path, cache: &Cache, quick: bool) -> Result<Vec<Contender>> {
    let shots = if quick { FEW_SHOTS } else { SHOTS };
    let reference = compile(root, cache, "rtl_ref", Sources::Reference, shots)?;
    let tuned = compile(root, cache, "tuned", Sources::TunedWithPll, shots)?;
    let waveforms = if quick { &[][..] } else { &[Work::Vcd, Work::Fst] };
    let waveforms: Vec<_> =
        waveforms.iter().map(|&work| Contender { work, ..tuned.clone() }).collect();
    Ok([vec![reference, tuned], waveforms].concat())
}

fn compile(
    root: &Path,
    cache: &Cache,
    variant: &'static str,
    sources: Sources,
    shots: u64,
) -> Result<Contender> {
    let bench = root.join("benches/peer_simulators");
    let mut verilog = sources.files(root)?;
    verilog.push(bench.join("icarus.v"));
    let mut all = verilog.clone();
    all.push(bench.join("rtl/edge.svh"));
    let parameter = format!("-Pbench.ShotsPerFrame={shots}");
    let build = |folder: &Path| {
        let mut command = Command::new("iverilog");
        command.args(OPTIONS.split_whitespace()).arg(&parameter).current_dir(root);
        command.arg(format!("-I{}", bench.join("rtl").display()));
        command.arg("-o").arg(folder.join("bench.vvp")).args(&verilog);
        run::stdout(&mut command).map(drop)
    };
    let flags = [OPTIONS.to_string(), parameter.clone()];
    let folder = cache.get(&format!("icarus_{variant}"), &all, &flags, build)?;
    Ok(Contender {
        simulator: "icarus",
        variant,
        work: Work::Cycle,
        call: Call::Vvp(folder.join("bench.vvp")),
        frames: if shots == SHOTS { 1 } else { 3 },
        shots,
        is_slow: shots == SHOTS,
        rtl: sources.rtl(),
    })
}
