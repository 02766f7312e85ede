//! `tofsim dpi`: checkers and photons in SystemVerilog, for a bench of the user's.

use std::path::PathBuf;
use std::sync::Arc;

use tofsim::error::{Error, Result};
use tofsim::files::folder::FolderLock;
use tofsim::files::output::write_bytes;
use tofsim::files::staged::StagedFolder;
use tofsim::scenario::{self, builtin};
use tofsim::sim::setup::Setup;
use tofsim_rtl::checkers::{Checkers, blocks_of};

use super::terminal::Talk;

/// Write checkers and photons for a bench of yours in SystemVerilog
///
/// DIR gets tofsim_pkg.sv (the imports), tofsim_photons.sv (tdc_stop as the scenario's light and detector make it),
/// tofsim_checkers.sv (a module for each block, which compares its outputs with the model's at every edge),
/// tofsim_bind.sv (binds them to modules of the same names, so that your RTL stays as it is), tofsim.h (the same for C)
/// and a Makefile. The model is a library:
///
///   cargo build --release -p tofsim-dpi
///
///   make -f DIR/Makefile verilator TOP=tb DESIGN="your files"
///
/// For Icarus, which has neither DPI nor bind, DIR gets tofsim_vpi.v (the same in Verilog, and tofsim_attach, a second
/// top that connects it) and tofsim_vpi.c (the functions over VPI).
///
/// docs/bench.md has a whole example. The first mismatch ends the simulation with cycle, signal, expected and got.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Built-in scenario or file: the instrument, and for photons its target and light
    #[arg(default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a key of the scenario, such as firmware.shots_per_frame=300; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// A block that is to have a checker; may be repeated [default: all that the scenario has]
    #[arg(short, long = "block", value_name = "BLOCK")]
    blocks: Vec<String>,
    /// Directory to write to
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

/// Runs the verb.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    let setup = Arc::new(Setup::new(scenario::load(&args.scenario, &args.set)?)?);
    let blocks: Vec<_> = match args.blocks.as_slice() {
        [] => blocks_of(&setup).iter().map(|spec| spec.name).collect(),
        blocks => blocks.iter().map(String::as_str).collect(),
    };
    let checkers = Checkers::new(setup, told(args)?, blocks)?;
    let _held = FolderLock::take(&args.output)?;
    let stage = StagedFolder::new(&args.output)?;
    let files = checkers.files().into_iter().chain([
        ("tofsim_vpi.v", checkers.verilog()),
        ("tofsim_vpi.c", include_str!("../../../dpi/vpi/tofsim_vpi.c").to_owned()),
        ("tofsim.h", include_str!("../../../dpi/include/tofsim.h").to_owned()),
        ("Makefile", include_str!("dpi/bench.mk").to_owned()),
    ]);
    for (name, text) in files {
        write_bytes(&stage.path().join(name), text)?;
    }
    stage.commit()?.iter().for_each(|path| talk.wrote(path));
    Ok(())
}

/// The scenario as the library is told it, from whatever folder the simulation runs.
fn told(args: &Args) -> Result<String> {
    let name = match builtin::scenario(&args.scenario) {
        Some(_) => args.scenario.clone(),
        None => {
            let path = PathBuf::from(&args.scenario);
            let path = path.canonicalize().map_err(Error::io(&path, "read"))?;
            path.display().to_string()
        }
    };
    Ok([&[name], args.set.as_slice()].concat().join("\n"))
}
