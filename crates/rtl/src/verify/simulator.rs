//! The two simulators: how each compiles a bench, runs it, and tells the ports of a module.

mod refusal;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use tofsim::error::{Error, Result, read_text};

use super::interface::{Interface, icarus, verilator};
use super::process::{self, Finished, IVERILOG, Limits, Tool, VERILATOR, VVP};
use super::rtl::Rtl;

/// A simulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simulator {
    /// Icarus Verilog: compiles at once.
    Icarus,
    /// Verilator: compiles for seconds, then runs fast.
    Verilator,
}

/// A compiled bench.
#[derive(Clone, Debug)]
pub struct Compiled {
    simulator: Simulator,
    /// The folder that it runs in, with the vectors.
    pub folder: PathBuf,
    program: PathBuf,
}

impl Simulator {
    /// Its name, as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Simulator::Icarus => "icarus",
            Simulator::Verilator => "verilator",
        }
    }

    /// Checks that it is installed.
    ///
    /// # Errors
    /// When a program of it is not on the PATH.
    pub fn check_is_installed(self) -> Result<()> {
        let tools: &[Tool] = match self {
            Simulator::Icarus => &[IVERILOG, VVP],
            Simulator::Verilator => &[VERILATOR],
        };
        tools.iter().try_for_each(Tool::check_is_installed)
    }

    /// Compiles `top`, which is in `bench`, with the design's files, to run in `folder`.
    ///
    /// # Errors
    /// When the simulator is missing, or refuses the sources; then its message is shown.
    pub fn compile(
        self,
        folder: &Path,
        top: &str,
        bench: &[PathBuf],
        rtl: &Rtl,
        registers: bool,
        limits: &Limits,
    ) -> Result<Compiled> {
        let (program, mut args) = match self {
            Simulator::Icarus => {
                let program = folder.join("bench.vvp");
                (program.clone(), icarus_args(top, &program))
            }
            Simulator::Verilator => {
                let more = ["-Mdir", "obj_dir", "-o", "bench"].map(OsString::from);
                (folder.join("obj_dir/bench"), verilator_args("--binary", top, more))
            }
        };
        args.extend(registers.then(|| "-DREGISTERS".into()));
        args.extend(bench.iter().map(OsString::from));
        let texts: Result<String> = bench.iter().map(|file| read_text(file)).collect();
        self.make(folder, top, &texts?, args, rtl, limits)?;
        Ok(Compiled { simulator: self, folder: folder.to_owned(), program })
    }

    /// Ports and parameters of a module with those parameters set, which decide how wide ports are.
    ///
    /// # Errors
    /// When the simulator is missing, refuses the sources, or finds no such module or parameter.
    pub fn interface(
        self,
        folder: &Path,
        module: &str,
        parameters: &[(&str, u64)],
        rtl: &Rtl,
        limits: &Limits,
    ) -> Result<Interface> {
        let (output, mut args, set) = match self {
            Simulator::Icarus => {
                let output = folder.join("ports.vvp");
                (output.clone(), icarus_args(module, &output), format!("-P{module}."))
            }
            Simulator::Verilator => {
                let output = folder.join("ports.xml");
                let more = ["--xml-output".into(), output.clone().into()];
                (output, verilator_args("--xml-only", module, more), "-G".to_owned())
            }
        };
        args.extend(parameters.iter().map(|(name, value)| format!("{set}{name}={value}").into()));
        self.make(folder, module, module, args, rtl, limits)?;
        let bytes = std::fs::read(&output).map_err(Error::io(&output, "read"))?;
        let text = String::from_utf8_lossy(&bytes);
        match self {
            Simulator::Icarus => Ok(icarus::read(&text)),
            Simulator::Verilator => verilator::read(&text, module),
        }
    }

    /// Compiles what `text` needs of the design with those arguments, of which `top` is one.
    fn make(
        self,
        folder: &Path,
        top: &str,
        text: &str,
        mut args: Vec<OsString>,
        rtl: &Rtl,
        limits: &Limits,
    ) -> Result<()> {
        let needed = rtl.needed(text)?;
        let options = &rtl.options;
        if needed.is_empty() && options.libraries.is_empty() && options.library_files.is_empty() {
            return Err(refusal::no_module(rtl, top).into());
        }
        let (tool, suffix, library) = match self {
            Simulator::Icarus => (IVERILOG, "-Y", "-l"),
            Simulator::Verilator => (VERILATOR, "+libext+", "-v"),
        };
        if self == Simulator::Icarus {
            let is_system_verilog = rtl.options.system_verilog
                || needed.iter().any(|source| source.is_system_verilog());
            args.push(if is_system_verilog { "-g2012" } else { "-g2005" }.into());
        }
        let joined = |option: &str, value: &OsString| {
            let mut word = OsString::from(option);
            word.push(value);
            word
        };
        args.extend(options.includes.iter().map(|folder| joined("-I", &folder.into())));
        args.extend(options.defines.iter().map(|define| joined("-D", &define.into())));
        for folder in &options.libraries {
            args.extend(["-y".into(), folder.into()]);
        }
        if !options.libraries.is_empty() {
            args.extend(rtl.suffixes().iter().map(|end| joined(suffix, &end.into())));
        }
        for file in &options.library_files {
            args.extend([library.into(), file.into()]);
        }
        args.extend(needed.iter().map(|source| OsString::from(&source.path)));
        let finished = tool.run(folder, args, limits)?;
        if finished.success() && !refusal::lacks_macro(&finished) {
            Ok(())
        } else {
            Err(refusal::of(rtl, top, &finished).into())
        }
    }
}

impl Compiled {
    /// Runs it with those plusargs.
    ///
    /// # Errors
    /// When it cannot be started, or the user stops everything.
    pub fn run(&self, plusargs: &[String], limits: &Limits) -> Result<Finished> {
        let mut args: Vec<OsString> = Vec::new();
        if self.simulator == Simulator::Icarus {
            args.extend(["-n".into(), self.program.clone().into()]);
        }
        args.extend(plusargs.iter().map(OsString::from));
        if self.simulator == Simulator::Icarus {
            return VVP.run(&self.folder, args, limits);
        }
        let mut command = Command::new(&self.program);
        command.args(args);
        process::run(command, &self.folder, limits)
    }
}

/// Icarus's arguments to compile `top` into a file, but for the sources.
fn icarus_args(top: &str, output: &Path) -> Vec<OsString> {
    let mut args = ["-grelative-include", "-s", top, "-o"].map(OsString::from).to_vec();
    args.push(output.into());
    args
}

/// Verilator's arguments to do something with `top`, but for the sources. It takes the first of two modules
/// of one name, and warns only, where Icarus refuses them.
fn verilator_args<const N: usize>(action: &str, top: &str, more: [OsString; N]) -> Vec<OsString> {
    let args = [
        action,
        "--timing",
        "--relative-includes",
        "-Wno-fatal",
        "-Wno-lint",
        "-Wno-style",
        "-Werror-MODDUP",
        "--top-module",
        top,
    ];
    args.map(OsString::from).into_iter().chain(more).collect()
}
