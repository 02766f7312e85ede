//! Verilator, with the sources in `rtl_ref` and with the fastest decoder.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::compilers::Workshop;
use crate::contender::{Call, Contender, Work};
use crate::sources::{Source, Sources};
use crate::{Result, run};

/// Options of every build.
pub const COMMON: &str = "--cc --exe --build -O3 --x-assign fast --x-initial fast --noassert";
/// C++ compiler options for code that runs in each cycle, where it is timed.
pub const OPT_FAST: &str = "-O3 -march=native";
/// Added to them for the model that records a profile, and for the one that is compiled with it.
pub const PROFILE_GUIDED: [&str; 2] =
    ["-fprofile-generate", "-fprofile-use -fprofile-correction -Wno-missing-profile"];
/// The same options where nothing is timed.
const OPT_CHECKED: &str = "-O0";

/// A variant of the model.
pub struct Variant {
    name: &'static str,
    variant: &'static str,
    work: Work,
    sources: Sources,
    has_profile: bool,
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
    has_profile: false,
    options: &[],
    define: "",
    link: "",
    frames: 2,
};

/// The fastest model.
const FASTEST: Variant = Variant {
    name: "verilator_fastest",
    variant: "rtl_ref, $countones, profile-guided",
    sources: Sources::FastDecoder,
    has_profile: true,
    ..REFERENCE
};

/// Variants to time.
pub const VARIANTS: [Variant; 4] = [
    REFERENCE,
    FASTEST,
    Variant {
        name: "verilator_vcd",
        variant: "rtl_ref, $countones, profile-guided, --trace",
        work: Work::Vcd,
        options: &["--trace", "--no-trace-params", "--trace-max-width", "800"],
        define: "-DTRACE_VCD",
        frames: 1,
        ..FASTEST
    },
    Variant {
        name: "verilator_fst",
        variant: "rtl_ref, $countones, profile-guided, --trace-fst",
        work: Work::Fst,
        options: &["--trace-fst", "--no-trace-params", "--trace-max-width", "800"],
        define: "-DTRACE_FST",
        link: "-lz",
        frames: 1,
        ..FASTEST
    },
];

impl Variant {
    /// Builds the peer.
    pub fn contender(&self, workshop: &Workshop) -> Result<Contender> {
        let Workshop { root, shots, .. } = *workshop;
        let bench = root.join("benches/peer_simulators");
        let mut sources = self.sources.modules(root)?;
        for file in ["driver.cpp", "protocol.h"] {
            sources.push(Source::read(&bench.join(file))?);
        }
        let (parameter, passes) = (format!("-GShotsPerFrame={shots}"), self.passes(workshop));
        let mut flags = [&[self.define, self.link, &parameter, COMMON], self.options].concat();
        flags.extend(passes.iter().map(String::as_str));
        let build = |folder: &Path, verilog: &[PathBuf]| {
            for (pass, options) in passes.iter().enumerate() {
                if pass > 0 {
                    self.learn(workshop, folder)?;
                }
                let mut command = self.command(folder, verilog, options);
                run::stdout(command.arg(&parameter).current_dir(root))?;
            }
            Ok(())
        };
        let folder = workshop.cache.get(self.name, &sources, &flags, build)?;
        Ok(Contender {
            simulator: "verilator",
            variant: self.variant,
            work: self.work,
            call: Call::Driver(folder.join("Vtof_top")),
            frames: self.frames,
            shots,
            is_slow: false,
        })
    }

    /// Returns the options of each pass of the C++ compiler.
    fn passes(&self, workshop: &Workshop) -> Vec<String> {
        if !workshop.is_timed {
            vec![OPT_CHECKED.to_owned()]
        } else if self.has_profile {
            PROFILE_GUIDED.map(|option| format!("{OPT_FAST} {option}")).to_vec()
        } else {
            vec![OPT_FAST.to_owned()]
        }
    }

    /// Runs a frame for the profile, and removes what was compiled to record it.
    fn learn(&self, workshop: &Workshop, folder: &Path) -> Result<()> {
        let mut command = Command::new(folder.join("Vtof_top"));
        command.args([workshop.training.laser_freq.to_string(), "1".into()]);
        command.arg(&workshop.training.photons).args(self.work.waveform(folder));
        run::driver(command.current_dir(workshop.root))?;
        for entry in fs::read_dir(folder)? {
            let file = entry?.path();
            let is_compiled = file.extension().is_some_and(|ending| ending == "o" || ending == "a");
            if is_compiled || file.file_name() == Some(OsStr::new("Vtof_top")) {
                fs::remove_file(file)?;
            }
        }
        Ok(())
    }

    fn command(&self, folder: &Path, verilog: &[PathBuf], fast: &str) -> Command {
        let Variant { link, define, .. } = self;
        let mut command = Command::new("verilator");
        command.args(COMMON.split_whitespace()).args(self.options);
        command.args(["-Wno-fatal", "-Wno-lint", "-Wno-TIMESCALEMOD", "--top-module", "tof_top"]);
        command.arg("-Mdir").arg(folder);
        command.args(["-CFLAGS", &format!("-I{} {define}", folder.display())]);
        command.args(["-LDFLAGS", &format!("{fast} {link}")]);
        let make = format!("OPT_FAST=\"{fast}\" OPT_SLOW=-O1 OPT_GLOBAL=\"{fast}\"");
        command.args(["-MAKEFLAGS", &make]).arg(folder.join("driver.cpp")).args(verilog);
        command
    }
}
