//! Verilator: the sources as they are, and the best that we could make of them.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::builds::Cache;
use crate::compilers::{Sources, absolute};
use crate::contender::{Call, Contender, SHOTS, Work};
use crate::{Result, run};

/// Options of every build.
pub const COMMON: &str = "--cc --exe --build -O3 --x-assign fast --x-initial fast --noassert";
/// Options of the C++ compiler for what runs each cycle.
pub const OPT_FAST: &str = "-O3 -march=native";
/// The same for the self-clocked model, which is compiled as one piece.
pub const WHOLE: &str = "-O3 -march=native -flto -finline-limit=10000 \
    --param inline-unit-growth=1000 --param large-function-growth=10000 \
    --param max-inline-insns-auto=10000";

/// A way to build the model.
pub struct Variant {
    name: &'static str,
    variant: &'static str,
    work: Work,
    sources: Sources,
    top: &'static str,
    options: &'static [&'static str],
    defines: &'static str,
    opt_fast: &'static str,
    /// For Verilator's own library, which writes the waveforms.
    opt_global: &'static str,
    link: &'static str,
    frames: u64,
}

/// The ways that are timed.
pub const VARIANTS: [Variant; 6] = [
    Variant {
        name: "verilator_ref",
        variant: "rtl_ref",
        work: Work::Cycle,
        sources: Sources::Reference,
        top: "tof_top",
        options: &[],
        defines: "",
        opt_fast: OPT_FAST,
        opt_global: "-O2",
        link: "",
        frames: 2,
    },
    Variant {
        name: "verilator_decoder",
        variant: "rtl_ref, $countones",
        work: Work::Cycle,
        sources: Sources::FastDecoder,
        top: "tof_top",
        options: &[],
        defines: "",
        opt_fast: OPT_FAST,
        opt_global: "-O2",
        link: "",
        frames: 2,
    },
    Variant {
        name: "verilator_tuned",
        variant: "tuned",
        work: Work::Cycle,
        sources: Sources::Tuned,
        top: "tof_top",
        options: &["--timescale-override", "1ps/1ps"],
        defines: "-DTUNED",
        opt_fast: OPT_FAST,
        opt_global: "-O2",
        link: "",
        frames: 4,
    },
    Variant {
        name: "verilator_best",
        variant: "tuned, self-clocked",
        work: Work::Cycle,
        sources: Sources::TunedWithBench,
        top: "bench",
        options: &["--converge-limit", "2000000000", "+define+SELF_CLOCKED"],
        defines: "-DSELF_CLOCKED",
        opt_fast: WHOLE,
        opt_global: "-O2",
        link: "-static",
        frames: 12,
    },
    Variant {
        name: "verilator_vcd",
        variant: "tuned, --trace",
        work: Work::Vcd,
        sources: Sources::Tuned,
        top: "tof_top",
        options: &["--timescale-override", "1ps/1ps", "--trace", "--no-trace-params"],
        defines: "-DTUNED -DTRACE_VCD",
        opt_fast: OPT_FAST,
        opt_global: OPT_FAST,
        link: "",
        frames: 1,
    },
    Variant {
        name: "verilator_fst",
        variant: "tuned, --trace-fst",
        work: Work::Fst,
        sources: Sources::Tuned,
        top: "tof_top",
        options: &["--timescale-override", "1ps/1ps", "--trace-fst", "--no-trace-params"],
        defines: "-DTUNED -DTRACE_FST",
        opt_fast: OPT_FAST,
        opt_global: OPT_FAST,
        link: "-lz",
        frames: 1,
    },
];

impl Variant {
    /// Builds it.
    pub fn contender(&self, root: &Path, cache: &Cache) -> Result<Contender> {
        let bench = root.join("benches/peer_simulators");
        let verilog = self.sources.files(root)?;
        let mut sources = verilog.clone();
        sources.extend(["driver.cpp", "protocol.h", "rtl/edge.svh"].map(|file| bench.join(file)));
        let build = |folder: &Path| {
            run::stdout(self.command(folder, &bench, &verilog).current_dir(root)).map(drop)
        };
        let folder = cache.get(self.name, &sources, &self.flags(), build)?;
        Ok(Contender {
            simulator: "verilator",
            variant: self.variant,
            work: self.work,
            call: Call::Driver(folder.join(format!("V{}", self.top))),
            frames: self.frames,
            shots: SHOTS,
            is_slow: false,
            rtl: self.sources.rtl(),
        })
    }

    /// What its build depends on beside its sources.
    fn flags(&self) -> Vec<String> {
        let own = [self.defines, self.opt_fast, self.opt_global, self.link, self.top, COMMON];
        own.iter().chain(self.options).map(|flag| flag.to_string()).collect()
    }

    fn command(&self, folder: &Path, bench: &Path, verilog: &[PathBuf]) -> Command {
        let Variant { opt_fast, opt_global, link, defines, .. } = self;
        let mut command = Command::new("verilator");
        command.args(COMMON.split_whitespace()).args(self.options);
        command.args(["-Wno-fatal", "-Wno-lint", "-Wno-TIMESCALEMOD", "--top-module", self.top]);
        command.arg(format!("-I{}", bench.join("rtl").display()));
        command.args(["-Mdir", &absolute(folder)]);
        command.args(["-CFLAGS", &format!("-I{} {defines}", absolute(bench))]);
        // What is compiled as one piece is optimised by the linker.
        command.args(["-LDFLAGS", &format!("{opt_fast} {link}")]);
        let make = format!("OPT_FAST=\"{opt_fast}\" OPT_SLOW=-O1 OPT_GLOBAL=\"{opt_global}\"");
        command.args(["-MAKEFLAGS", &make]).arg(bench.join("driver.cpp")).args(verilog);
        command
    }
}
