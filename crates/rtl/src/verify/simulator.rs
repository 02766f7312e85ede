//! The two simulators: how each compiles a bench, runs it, and tells the ports of a module.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use tofsim::error::{Error, Input, Result};

use super::interface::{Interface, icarus, verilator};
use super::process::{self, End, Finished, IVERILOG, Limits, VERILATOR, VVP};
use super::rtl::Rtl;

/// Which simulator.
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
                (program.clone(), icarus_args(rtl, top, &program))
            }
            Simulator::Verilator => {
                let more = ["-Mdir", "obj_dir", "-o", "bench"].map(OsString::from);
                (folder.join("obj_dir/bench"), verilator_args("--binary", top, more))
            }
        };
        args.extend(registers.then(|| "-DREGISTERS".into()));
        args.extend(bench.iter().map(OsString::from));
        self.make(folder, top, args, rtl, limits)?;
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
                (output.clone(), icarus_args(rtl, module, &output), format!("-P{module}."))
            }
            Simulator::Verilator => {
                let output = folder.join("ports.xml");
                let more = ["--xml-output".into(), output.clone().into()];
                (output, verilator_args("--xml-only", module, more), "-G".to_owned())
            }
        };
        args.extend(parameters.iter().map(|(name, value)| format!("{set}{name}={value}").into()));
        self.make(folder, module, args, rtl, limits)?;
        let bytes = std::fs::read(&output).map_err(Error::io(&output, "read"))?;
        let text = String::from_utf8_lossy(&bytes);
        match self {
            Simulator::Icarus => Ok(icarus::read(&text)),
            Simulator::Verilator => verilator::read(&text, module),
        }
    }

    /// Compiles the design's files with those arguments, of which `top` is one.
    fn make(
        self,
        folder: &Path,
        top: &str,
        args: Vec<OsString>,
        rtl: &Rtl,
        limits: &Limits,
    ) -> Result<()> {
        let tool = match self {
            Simulator::Icarus => IVERILOG,
            Simulator::Verilator => VERILATOR,
        };
        let args = args.into_iter().chain(rtl.files.iter().map(OsString::from));
        let finished = tool.run(folder, args, limits)?;
        let says = ["Unable to find the root module", "was not found in design"];
        if says.iter().any(|text| finished.output.contains(text)) {
            let fault = Input::new(&rtl.source, "no such module in it").field("module");
            return Err(fault.value(top).into());
        }
        if finished.success() { Ok(()) } else { Err(refused(rtl, &finished).into()) }
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
fn icarus_args(rtl: &Rtl, top: &str, output: &Path) -> Vec<OsString> {
    let mut args = [generation(rtl), "-s", top, "-o"].map(OsString::from).to_vec();
    args.push(output.into());
    args
}

/// Verilator's arguments to do something with `top`, but for the sources.
fn verilator_args<const N: usize>(action: &str, top: &str, more: [OsString; N]) -> Vec<OsString> {
    let args = [action, "--timing", "-Wno-fatal", "-Wno-lint", "-Wno-style", "--top-module", top];
    args.map(OsString::from).into_iter().chain(more).collect()
}

/// The language: Verilog-2005 unless there is SystemVerilog.
fn generation(rtl: &Rtl) -> &'static str {
    if rtl.is_system_verilog() { "-g2012" } else { "-g2005" }
}

/// Lines of a simulator's message that are passed on.
const LINES: usize = 12;

fn refused(rtl: &Rtl, finished: &Finished) -> Input {
    let unknown = |line: &str| Some(line.split_once("Unknown module type: ")?.1.to_owned());
    if let Some(module) = finished.output.lines().find_map(unknown) {
        return Input::new(&rtl.source, format!("it has no module `{module}`"));
    }
    let message: Vec<_> = finished.output.lines().take(LINES).collect();
    let what = match finished.end {
        End::Exit(_) => "the simulator does not take it",
        _ => "the simulator took too long to compile it",
    };
    Input::new(&rtl.source, format!("{what}:\n{}", message.join("\n")))
}
