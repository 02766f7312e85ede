//! `tofsim dpi`: checkers and photons in SystemVerilog, for a bench of the user's.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use tofsim::error::{Error, Input, Result, hint};
use tofsim::files::folder::FolderLock;
use tofsim::files::output::write_bytes;
use tofsim::files::staged::StagedFolder;
use tofsim::scenario::builtin::{self, Source};
use tofsim::scenario::{Loaded, bundle};
use tofsim::sim::setup::Setup;
use tofsim_rtl::checkers::{Checkers, blocks_of};

use super::options::ScenarioArgs;
use super::terminal::Console;

/// Write checkers and photons for your own SystemVerilog bench
///
/// DIR gets tofsim_pkg.sv (the imports), tofsim_photons.sv (tdc_stop as the scenario's light and detector make it),
/// tofsim_checkers.sv (a module for each block, which compares its outputs with the model's at every edge),
/// tofsim_bind.sv (binds them to modules of the same names, so that your RTL stays as it is), tofsim.h (the same for C)
/// and a Makefile. For Icarus, which has neither DPI nor bind, there are tofsim_vpi.v (the same in Verilog, and
/// tofsim_attach, a second top that connects it) and tofsim_vpi.c (the functions over VPI). The scenario's file is read
/// when the simulation begins.
///
/// The first mismatch ends the simulation with cycle, signal, expected and got. docs/bench.md has a whole example, all
/// plusargs and variables, and what was tried in which simulator.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim dpi -o dpi                    all blocks of the KC705's design\n  \
    tofsim dpi mine.toml -b tdc -o dpi   one block of your own instrument\n  \
    tofsim dpi --without pll -o dpi      if the bench's PLL has jitter\n  \
    cargo build --release -p tofsim-dpi  build the library, in a clone\n  \
    make -f dpi/Makefile verilator LIB=target/release TOP=tb DESIGN=\"FILES\"\n  \
    make -f dpi/Makefile icarus LIB=target/release TOP=tb DESIGN=\"FILES\"")]
pub struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,
    /// Write a checker for this block; may be repeated [default: all blocks of the scenario]
    #[arg(short, long = "block", value_name = "BLOCK")]
    blocks: Vec<String>,
    /// Write no checker for this block, e.g. pll if yours has jitter; may be repeated
    #[arg(long, value_name = "BLOCK", conflicts_with = "blocks")]
    without: Vec<String>,
    /// Directory to write to
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let loaded = args.scenario.load(None)?;
    let configuration = configuration(args, &loaded)?;
    let setup = Arc::new(Setup::new(loaded)?);
    let checkers = Checkers::new(Arc::clone(&setup), configuration, blocks(args, &setup)?)?;
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
    stage.commit()?.iter().for_each(|path| console.wrote(path));
    Ok(())
}

/// The blocks that are to have checkers, each once.
fn blocks<'a>(args: &'a Args, setup: &Setup) -> Result<Vec<&'a str>> {
    let all: Vec<&str> = blocks_of(setup).iter().map(|spec| spec.name).collect();
    if let Some(other) = args.without.iter().find(|name| !all.contains(&name.as_str())) {
        let (hint, names) = hint(other, all.iter().copied());
        let expected = format!("no such block{hint}; there are {names}");
        return Err(Input::new("--without", expected).value(other).into());
    }
    let mut blocks: Vec<&str> = args.blocks.iter().map(String::as_str).collect();
    if blocks.is_empty() {
        blocks =
            all.into_iter().filter(|name| !args.without.iter().any(|own| own == name)).collect();
    }
    let mut seen = BTreeSet::new();
    blocks.retain(|name| seen.insert(*name));
    Ok(blocks)
}

/// Returns the scenario for the library: a line with its name or absolute path, and one for each key that is set. Paths
/// are absolute, because the simulation may run in any folder.
fn configuration(args: &Args, loaded: &Loaded) -> Result<String> {
    let absolute = |path: &Path| -> Result<String> {
        let path = path.canonicalize().map_err(Error::io(path, "read"))?;
        Ok(path.display().to_string())
    };
    let named: Vec<_> = bundle::names(&loaded.scenario).map(|(_, name)| name).collect();
    // From a file's scenario, files are seen from its folder.
    let is_file_from_here = |value: &str| {
        let is_path = value.contains(['/', '.']) && named.contains(&value);
        loaded.files == Source::BuiltIn && is_path && Path::new(value).is_file()
    };
    let mut lines = vec![match builtin::scenario(&args.scenario.scenario) {
        Some(_) => args.scenario.scenario.clone(),
        None => absolute(Path::new(&args.scenario.scenario))?,
    }];
    for set in &args.scenario.set {
        let (key, value) = set.split_once('=').unwrap_or((set, ""));
        let value = value.trim().trim_matches('"');
        lines.push(if is_file_from_here(value) {
            format!("{key}={}", toml::Value::from(absolute(Path::new(value))?))
        } else {
            set.clone()
        });
    }
    if let Some(line) = lines.iter().find(|line| line.contains('\n')) {
        let expected =
            "expected a path and values without line ends, because a bench reads them line by line";
        return Err(Input::new("scenario", expected).value(format!("{line:?}")).into());
    }
    Ok(lines.join("\n"))
}
