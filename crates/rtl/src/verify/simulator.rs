//! The two simulators: how each compiles a bench, runs it, and tells the ports of a module.

mod arguments;
mod job;
mod refusal;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

pub use arguments::QUICK_TO_COMPILE;

use arguments::SourceOptions;
use job::Job;

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

/// Ways to compile a design that a simulator refuses: a simulator, whether Verilog is read as SystemVerilog, and what
/// the user has to do.
const WAYS: [(Simulator, bool, &str); 3] = [
    (
        Simulator::Icarus,
        true,
        "Icarus Verilog accepts these files as SystemVerilog: name them .sv, or put -sv into a file list",
    ),
    (Simulator::Verilator, false, "Verilator accepts these files: verify --simulator verilator"),
    (Simulator::Icarus, false, "Icarus Verilog accepts these files: verify --simulator icarus"),
];

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
        let program = folder.join(match self {
            Simulator::Icarus => "bench.vvp",
            Simulator::Verilator => "obj_dir/bench",
        });
        let action = match self {
            Simulator::Icarus => arguments::icarus(top, &program),
            Simulator::Verilator => arguments::verilator(
                "--binary",
                top,
                ["-Mdir", "obj_dir", "-o", "bench"].into_iter().chain(QUICK_TO_COMPILE),
            ),
        };
        let texts: Result<String> = bench.iter().map(|file| read_text(file)).collect();
        let mut job = Job::new(folder, top, &texts?, rtl, limits)?;
        job.first.extend(registers.then(|| "-DREGISTERS".into()));
        // By a path without the folder's name, ccache knows the bench's program again.
        let inside = |file: &PathBuf| file.strip_prefix(folder).unwrap_or(file).into();
        job.first.extend(bench.iter().map(inside));
        self.make(&job, action)?;
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
        let (output, mut action, set) = match self {
            Simulator::Icarus => {
                let output = folder.join("ports.vvp");
                (output.clone(), arguments::icarus(module, &output), format!("-P{module}."))
            }
            Simulator::Verilator => {
                let output = folder.join("ports.xml");
                let mut action = arguments::verilator("--xml-only", module, ["--xml-output"]);
                action.push(output.clone().into());
                (output, action, "-G".to_owned())
            }
        };
        action.extend(parameters.iter().map(|(name, value)| format!("{set}{name}={value}").into()));
        self.make(&Job::new(folder, module, module, rtl, limits)?, action)?;
        let bytes = std::fs::read(&output).map_err(Error::io(&output, "read"))?;
        let text = String::from_utf8_lossy(&bytes);
        match self {
            Simulator::Icarus => Ok(icarus::read(&text)),
            Simulator::Verilator => verilator::read(&text, module),
        }
    }

    /// Compiles a design, which those arguments begin with.
    fn make(self, job: &Job, mut args: Vec<OsString>) -> Result<()> {
        let (tool, options) = self.compiler();
        args.extend(job.arguments(&options, job.is_system_verilog()));
        let mut finished = tool.run(job.folder, args, job.limits)?;
        finished.output = job.with_originals(&finished.output);
        if finished.success() && !refusal::lacks_macro(&finished) {
            return Ok(());
        }
        Err(refusal::of(job.rtl, job.top, &finished, || self.other_way(job)).into())
    }

    /// Its compiler, and the compiler's options for sources.
    fn compiler(self) -> (Tool, SourceOptions) {
        match self {
            Simulator::Icarus => (IVERILOG, arguments::ICARUS),
            Simulator::Verilator => (VERILATOR, arguments::VERILATOR),
        }
    }

    /// Returns how a design that this simulator refuses can be compiled, if it can.
    fn other_way(self, job: &Job) -> Option<&'static str> {
        let is_system_verilog = job.is_system_verilog();
        let is_other = |(simulator, as_system_verilog, _): &&(Simulator, bool, &str)| {
            if *as_system_verilog {
                self == *simulator && !is_system_verilog
            } else {
                self != *simulator
            }
        };
        let mut ways = WAYS.iter().filter(is_other);
        let way = ways.find(|(simulator, as_system_verilog, _)| {
            simulator.accepts(job, is_system_verilog || *as_system_verilog)
        });
        way.map(|(_, _, hint)| *hint)
    }

    /// Returns whether it is installed and takes a design, without compiling it.
    fn accepts(self, job: &Job, is_system_verilog: bool) -> bool {
        let (tool, options) = self.compiler();
        let mut args = match self {
            Simulator::Icarus => arguments::icarus(job.top, Path::new("null")),
            Simulator::Verilator => arguments::verilator("--lint-only", job.top, []),
        };
        args.extend((self == Simulator::Icarus).then(|| "-tnull".into()));
        args.extend(job.arguments(&options, is_system_verilog));
        let finished = tool.run(job.folder, args, job.limits);
        finished.is_ok_and(|finished| finished.success() && !refusal::lacks_macro(&finished))
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
