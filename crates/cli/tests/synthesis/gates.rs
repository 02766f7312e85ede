//! The core as primitives, in a simulator.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use tofsim::files::output::write_file;
use tofsim_rtl::golden::bench::Bench;
use tofsim_rtl::golden::{Setting, Vectors, blocks};
use tofsim_rtl::verify::{Rtl, Simulator, Verdict, rtl};

use crate::common;
use crate::lockstep::recorded::CHECKING;
use crate::record::{Inputs, Record};

use super::yosys::{self, LIMITS, Sources};

/// Shots of a frame; synthesis fixes it, as it does the contents of the ROMs.
const SHOTS: u64 = 300;
/// Frames: the second one needs the clearing of the first one's histogram.
const FRAMES: u64 = 2;

static CORE: LazyLock<Record> = LazyLock::new(|| {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/synthesis/core.record");
    Record::read(path, "cargo test -p tofsim-cli --test cli the_synthesised_core -- --ignored")
});

/// Modules that are primitives without a useful model: CARRY4 has no delay for each tap, and there
/// is none for PLLE2. They stay as they are in simulation.
const KEPT: [&str; 4] = ["carry_chain", "ddr_output", "lvds_output", "pll"];

/// Synthesises the core: the folder with `netlist.v` and, in `cells.txt`, where Yosys has its models.
fn netlist(sources: &Sources) -> PathBuf {
    let mut sources = yosys::needed(sources, "tof_top");
    sources.remove("kc705_top.v");
    sources.remove("ecp5_top.v");
    let rest = yosys::modules(&sources).filter(|name| !KEPT.contains(name));
    // Look-up tables stay expressions: Yosys takes minutes to make a primitive for each of thousands of contents.
    // Vectors are split, because Icarus takes minutes for one with a driver for each of 800 bits.
    let script = format!(
        "tee -q -o cells.txt read_verilog -lib +/xilinx/cells_sim.v\n\
         read_verilog -lib {}\nread_verilog -DROM_IN_LUTS {}\n\
         chparam -set ShotsPerFrame {SHOTS} tof_top\n\
         synth_xilinx -family xc7 -top tof_top -flatten -noiopad -noclkbuf -run begin:map_luts\n\
         opt_expr -mux_undef -noclkinv\nabc -luts 2:2,3,6:5,10,20\nclean\n\
         techmap -map +/xilinx/ff_map.v\nxilinx_srl -fixed -minlen 3\n\
         techmap -map +/xilinx/cells_map.v -D LUT_WIDTH=6\nclean\nhierarchy -check\n\
         tee -q -o stat.json stat -json\n\
         splitnets\nopt_clean -purge\nrename tof_top tof_top_netlist\n\
         write_verilog -noattr netlist.v\n",
        yosys::paths(KEPT),
        yosys::paths(rest),
    );
    yosys::results(&sources, &script)
}

/// Yosys's models of the primitives.
fn models(netlist: &Path) -> PathBuf {
    let log = fs::read_to_string(netlist.join("cells.txt")).unwrap();
    let path = log.split(['`', '\'']).find(|word| word.ends_with("cells_sim.v")).unwrap();
    PathBuf::from(path)
}

/// A `tof_top` with the parameters that the bench sets, around the netlist, which has none.
fn wrapper(vectors: &Vectors) -> String {
    let parameters: Vec<_> =
        vectors.parameters.iter().map(|(name, _)| format!("    parameter {name} = 0")).collect();
    let ports = vectors.spec.ports(&vectors.sizes);
    let declared: Vec<_> = ports
        .iter()
        .map(|port| {
            let direction = if port.output { "output" } else { "input" };
            format!("    {direction} wire [{}:0] {}", port.width - 1, port.name)
        })
        .collect();
    let connected: Vec<_> =
        ports.iter().map(|port| format!("        .{0}({0})", port.name)).collect();
    format!(
        "`timescale 1ps / 1fs\n`default_nettype none\n\nmodule tof_top #(\n{}\n) (\n{}\n);\n    \
         tof_top_netlist core (\n{}\n    );\n    \
         defparam core.pll.LockTime = LockTime;\n    \
         defparam core.\\tdc.carry_chain .DelaysFile = DelaysFile;\nendmodule\n",
        parameters.join(",\n"),
        declared.join(",\n"),
        connected.join(",\n"),
    )
}

/// What the golden bench of the whole firmware says of the synthesised core, by the record.
pub fn compare(sources: &Sources) -> String {
    let shots = format!("firmware.shots_per_frame={SHOTS}");
    let setting = Setting::new(common::setup("kc705", &[&shots]));
    let setting = Setting { as_configured: true, frames: FRAMES, ..setting };
    let spec = blocks::find("tof_top").unwrap();
    let vectors = (spec.record)(spec, &setting).unwrap();
    let folder = common::empty();
    Bench::new(&vectors).write(folder.path()).unwrap();
    CORE.answer("tof_top as primitives", &inputs(sources, folder.path()), || {
        let verdict = run(sources, &vectors, folder.path());
        let said = format!("{verdict:?}");
        if verdict == Verdict::Pass { Ok(said) } else { Err(said) }
    })
}

/// All that Yosys and Icarus read, with a bench in a folder.
fn inputs(sources: &Sources, bench: &Path) -> Inputs {
    let mut inputs = Inputs::default()
        .version("yosys", "-V")
        .version("iverilog", "-V")
        .rust("making", concat!(include_str!("gates.rs"), include_str!("yosys.rs")))
        .rust("checking", CHECKING);
    for (name, text) in yosys::needed(sources, "tof_top") {
        inputs = inputs.verilog(&name, &text);
    }
    for name in common::files(bench).iter().filter(|name| *name != "ports.json") {
        inputs = inputs.text(name, fs::read(bench.join(name)).unwrap());
    }
    inputs
}

/// Runs the bench that is in a folder on the netlist.
fn run(sources: &Sources, vectors: &Vectors, work: &Path) -> Verdict {
    let netlist = netlist(sources);
    let write = |name: &str, text: &str| {
        write_file(&work.join(name), |file| file.write_all(text.as_bytes())).unwrap();
        work.join(name)
    };
    let mut files = vec![netlist.join("netlist.v"), models(&netlist)];
    for name in KEPT {
        let name = format!("{name}.v");
        files.push(write(&name, &sources[&name]));
    }
    let rtl = Rtl::read(&rtl::Sources { paths: files, ..rtl::Sources::default() }).unwrap();
    let bench = [work.join(vectors.bench_module() + ".v"), write("tof_top.v", &wrapper(vectors))];
    let compiled = Simulator::Icarus
        .compile(work, "tb_tof_top", &bench, &rtl, false, &LIMITS)
        .unwrap_or_else(|error| panic!("{error}"));
    let from_power_up = ["+from_power_up".to_owned()];
    let finished = compiled.run(&from_power_up, &LIMITS).unwrap_or_else(|error| panic!("{error}"));
    Verdict::read(&finished.output, finished.end)
}
