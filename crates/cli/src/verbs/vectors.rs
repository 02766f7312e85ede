//! `tofsim vectors`: what each block does, clock by clock, with a bench that checks it.

use std::path::PathBuf;
use std::time::Duration;

use serde_json::json;

use tofsim::error::{Input, Result, nearest};
use tofsim::files::folder::FolderLock;
use tofsim::files::staged::{ScratchFolder, StagedFolder};
use tofsim::scenario;
use tofsim_rtl::golden::bench::{Bench, Language};
use tofsim_rtl::golden::{BLOCKS, Setting, Spec, blocks};
use tofsim_rtl::verify::process::Limits;
use tofsim_rtl::verify::task::DEFAULT;
use tofsim_rtl::verify::{Dut, RtlMap, Simulator, Task};

use crate::choice::{self, seed, words};
use crate::record::Record;
use crate::report::verification::open_input;

use super::design::Design;
use super::terminal::Console;

/// Write golden vectors of a block with a self-checking bench
///
/// DIR/BLOCK gets stimulus.mem and expected.mem (one line per clock), ports.json (order and widths of
/// their columns, clock, reset, latency), tb_BLOCK.v, and the memories that the block loads. The bench
/// runs in any simulator of Verilog or SystemVerilog:
///
///   cd DIR/BLOCK && iverilog -g2005 -o tb tb_BLOCK.v YOUR_FILES.v && vvp tb
///
/// With --rtl and --map the bench is for your module and uses its names; BLOCK_adapter.v implements the map. Icarus
/// reads the ports. With --rtl alone the bench also checks that outputs past the last neuron stay 0.
///
/// A configuration, such as tdc.leading, has a folder of its name.
///
/// With --language vhdl it is tb_BLOCK.vhd, in VHDL-2008 for std_logic and std_logic_vector ports. It was run in
/// GHDL; it uses no extensions of GHDL, but was not tried in NVC, Questa or xsim:
///
///   cd DIR/BLOCK && ghdl -i --std=08 tb_BLOCK.vhd YOUR_FILES.vhd
///
///   ghdl -m --std=08 tb_BLOCK && ghdl -r --std=08 tb_BLOCK
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Module of the firmware, one of its configurations, e.g. tdc.leading, or all modules (`all`)
    block: String,
    /// Directory to write to
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    design: Design,
    /// Map file (TOML) with the intended differences of your design (--rtl), which BLOCK_adapter.v implements
    #[arg(long, value_name = "FILE", requires = "sources", conflicts_with = "language")]
    map: Option<PathBuf>,
    /// Language of the bench
    #[arg(long, value_parser = words(choice::LANGUAGE), default_value = "verilog")]
    language: Language,
    #[command(flatten)]
    from: From,
}

/// Source of the vectors.
#[derive(Clone, Debug, clap::Args)]
pub struct From {
    /// Clock cycles of each block [default: 20000, more where a goal of the stimulus needs them;
    /// whole frames of a scenario]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    cycles: Option<u64>,
    /// Seed of the stimulus [default: the scenario's]
    #[arg(long, value_name = "N", value_parser = seed())]
    seed: Option<u64>,
    /// Built-in scenario or file: network, chain and, for tof_top, what it runs
    #[arg(long, value_name = "NAME|FILE")]
    scenario: Option<String>,
    /// Set a scenario key, e.g. `firmware.shots_per_frame=300`; may be repeated
    #[arg(short = 's', long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Frames of the scenario that tof_top runs
    #[arg(long, value_name = "N", default_value_t = 1,
        value_parser = clap::value_parser!(u64).range(1..=1000))]
    frames: u64,
}

impl From {
    /// The setting.
    ///
    /// # Errors
    /// When the scenario cannot be loaded.
    pub fn setting(&self) -> Result<Setting> {
        let name = self.scenario.as_deref().unwrap_or(scenario::DEFAULT);
        let setting = Setting::of(scenario::load(name, &self.set)?)?;
        let seed = self.seed.unwrap_or(setting.seed);
        let cycles = self.cycles.map(|cycles| cycles as usize);
        let as_configured = self.scenario.is_some() || !self.set.is_empty() || self.frames > 1;
        Ok(Setting { as_configured, seed, cycles, frames: self.frames, ..setting })
    }
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let setting = args.from.setting()?;
    let map = args.map.as_deref().map(RtlMap::read).transpose()?;
    let tasks = tasks(&args.block, &setting, map.as_ref())?;
    let rtl = if args.design.is_ours() { None } else { Some(args.design.read(console)?) };
    let limits = Limits::new(Duration::from_secs(300));
    let dut = rtl.as_ref().map(|rtl| Dut {
        rtl,
        map: map.as_ref(),
        simulator: Simulator::Icarus,
        limits,
    });
    let _held = FolderLock::take(&args.output)?;
    let stage = StagedFolder::new(&args.output)?;
    let scratch = ScratchFolder::new()?;
    for task in tasks {
        let spec = task.spec;
        let vectors = (spec.record)(spec, &task.setting)?;
        let folder = stage.path().join(&task.name);
        let mut bench = Bench::new(&vectors);
        bench.language = args.language;
        bench.about = json!(record(&setting, &console.command, &task.name));
        if let Some(dut) = &dut {
            let open = dut.fit(&mut bench, &task, &scratch.path().join(&task.name), &folder)?;
            let open = open.iter().map(|input| open_input(spec.name, input));
            console.print_notes(&open.collect::<Vec<_>>())?;
        }
        bench.write(&folder)?;
        console.detail(format_args!("{}: {} cycles", task.name, vectors.stimulus.rows()));
    }
    stage.commit()?.iter().for_each(|path| console.wrote(path));
    Ok(())
}

/// The blocks as the scenario has them, or one in a configuration.
fn tasks(block: &str, setting: &Setting, map: Option<&RtlMap>) -> Result<Vec<Task>> {
    if block == "all" {
        return Ok(BLOCKS.iter().map(|spec| Task::new(spec, setting, map)).collect());
    }
    let (spec, configuration) = configured(block, setting, "BLOCK")?;
    Task::every(spec, Some(configuration.unwrap_or(DEFAULT)), setting, map)
}

/// Returns the record of a block's vectors.
fn record(setting: &Setting, command: &[String], name: &str) -> Record {
    let mut record = Record { seed: setting.seed, ..Record::new(&setting.setup, command) };
    // Of all blocks, this one is enough.
    if let Some(block) = record.command.last_mut() {
        name.clone_into(block);
    }
    record
}

/// The block of a name, and one of its configurations where the name goes on: `tdc.leading`.
///
/// # Errors
/// When there is none, or the setting is a scenario's, which says what the block is; the error names `source`.
pub fn configured<'a>(
    name: &'a str,
    setting: &Setting,
    source: &str,
) -> Result<(&'static Spec, Option<&'a str>)> {
    let (block, configuration) =
        name.split_once('.').map_or((name, None), |(block, rest)| (block, Some(rest)));
    let spec = find(block, source)?;
    let Some(configuration) = configuration else { return Ok((spec, None)) };
    let others = spec.configurations.iter().map(|other| other.name);
    let known: Vec<_> = [DEFAULT].into_iter().chain(others).collect();
    if !known.contains(&configuration) {
        let expected =
            format!("no such configuration of {block}; expected one of {}", known.join(", "));
        return Err(Input::new(source, expected).value(configuration).into());
    }
    if setting.as_configured && configuration != DEFAULT {
        let expected = "expected no configuration: a scenario or a key says what the block is";
        return Err(Input::new(source, expected).value(name).into());
    }
    Ok((spec, Some(configuration)))
}

/// The block called `name`.
///
/// # Errors
/// When there is none; the error names `source`.
pub fn find(name: &str, source: &str) -> Result<&'static Spec> {
    blocks::find(name).ok_or_else(|| {
        let names: Vec<_> = BLOCKS.iter().map(|spec| spec.name).collect();
        let hint = nearest(name, names.iter().copied());
        let hint = hint.map_or(String::new(), |name| format!(" (did you mean {name}?)"));
        let expected = format!("no such block{hint}; expected all or one of {}", names.join(", "));
        Input::new(source, expected).value(name).into()
    })
}
