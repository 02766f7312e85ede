//! Verilator, with the sources in `rtl_ref` and with the fastest decoder.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::builds::Cache;
use crate::compilers::{Sources, absolute};
use crate::contender::{Call, Contender, SHOTS, Work};
use crate::{Result, run};

/// Options of every build.
pub const COMMON: &str = "--cc --exe --build -O3 --x-assign fast --x-initial fast --noassert";
/// C++ compiler options for code that runs in each cycle.
pub const OPT_FAST: &str = "-O3 -march=native";

/// A variant of the model.
pub struct Variant {
    name: &'static str,
    variant: &'static str,
    work: Work,
    sources: Sources,
    options: &'static [&'static str],
    define: &'static str,
    link: &'static str,
    frames: u64,
}

/// The model with default options.
const REFERENCE: Variant = Variant {
    name: "verilator_ref",
    variant: "rtl_ref",
    work: Work::Cycle,
    sources: Sources::Reference,
    options: &[],
    define: "",
    link: "",
    frames: 2,
};

/// Variants to time.
pub const VARIANTS: [Variant; 4] = [
    REFERENCE,
    Variant {
        name: "verilator_decoder",
        variant: "rtl_ref, $countones",
        sources: Sources::FastDecoder,
        ..REFERENCE
    },
    Variant {
        name: "verilator_vcd",
        variant: "rtl_ref, $countones, --trace",
        work: Work::Vcd,
        sources: Sources::FastDecoder,
        options: &["--trace", "--no-trace-params", "--trace-max-width", "800"],
        define: "-DTRACE_VCD",
        link: "",
        frames: 1,
    },
    Variant {
        name: "verilator_fst",
        variant: "rtl_ref, $countones, --trace-fst",
        work: Work::Fst,
        sources: Sources::FastDecoder,
        options: &["--trace-fst", "--no-trace-params", "--trace-max-width", "800"],
        define: "-DTRACE_FST",
        link: "-lz",
        frames: 1,
    },
];

impl Variant {
    /// Builds the peer.
    pub fn contender(&self, root: &Path, cache: &Cache) -> Result<Contender> {
        let bench = root.join("benches/peer_simulators");
        let verilog = self.sources.files(root)?;
        let mut sources = verilog.clone();
        sources.extend(["driver.cpp", "protocol.h"].map(|file| bench.join(file)));
        let build = |folder: &Path| {
            run::stdout(self.command(folder, &bench, &verilog).current_dir(root)).map(drop)
        };
        let folder = cache.get(self.name, &sources, &self.flags(), build)?;
        Ok(Contender {
            simulator: "verilator",
            variant: self.variant,
            work: self.work,
            call: Call::Driver(folder.join("Vtof_top")),
            frames: self.frames,
            shots: SHOTS,
            is_slow: false,
        })
    }

    /// Returns the inputs of the build other than its sources.
    fn flags(&self) -> Vec<String> {
        let own = [self.define, self.link, OPT_FAST, COMMON];
        own.iter().chain(self.options).map(|flag| flag.to_string()).collect()
    }

    fn command(&self, folder: &Path, bench: &Path, verilog: &[PathBuf]) -> Command {
        let Variant { link, define, .. } = self;
        let mut command = Command::new("verilator");
        command.args(COMMON.split_whitespace()).args(self.options);
        command.args(["-Wno-fatal", "-Wno-lint", "-Wno-TIMESCALEMOD", "--top-module", "tof_top"]);
        command.args(["-Mdir", &absolute(folder)]);
        command.args(["-CFLAGS", &format!("-I{} {define}", absolute(bench))]);
        command.args(["-LDFLAGS", &format!("{OPT_FAST} {link}")]);
        let make = format!("OPT_FAST=\"{OPT_FAST}\" OPT_SLOW=-O1 OPT_GLOBAL=\"{OPT_FAST}\"");
        command.args(["-MAKEFLAGS", &make]).arg(bench.join("driver.cpp")).args(verilog);
        command
    }
}
