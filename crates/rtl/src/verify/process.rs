//! Runs other people's programs: with a time limit, and never leaving a child behind.

mod limits;
mod processor_time;
mod watch;

use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use process_wrap::std::{ChildWrapper, CommandWrap, ProcessGroup};

use tofsim::error::{Error, Input, Result, poll_stop};

use limits::LONGEST;
use watch::Watch;

pub use limits::{End, Limits, Overrun};

/// A program and the Debian package that has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tool {
    /// Its name on the PATH.
    pub program: &'static str,
    /// Debian's package.
    pub package: &'static str,
}

/// Icarus Verilog's compiler.
pub const IVERILOG: Tool = Tool { program: "iverilog", package: "iverilog" };
/// Icarus Verilog's simulator.
pub const VVP: Tool = Tool { program: "vvp", package: "iverilog" };
/// Verilator.
pub const VERILATOR: Tool = Tool { program: "verilator", package: "verilator" };
/// Yosys.
pub const YOSYS: Tool = Tool { program: "yosys", package: "yosys" };

/// GHDL.
pub const GHDL: Tool = Tool { program: "ghdl", package: "ghdl" };
/// The shell.
pub const SHELL: Tool = Tool { program: "sh", package: "dash" };

/// Outcome of a program.
#[derive(Clone, Debug)]
pub struct Finished {
    /// By itself or not.
    pub end: End,
    /// Its standard output and standard error, in that order.
    pub output: String,
}

/// First and longest time between two looks at a program.
const NAP: (Duration, Duration) = (Duration::from_millis(1), Duration::from_millis(20));

impl Finished {
    /// Returns whether it ended by itself and says that all went well.
    pub fn success(&self) -> bool {
        self.end == End::Exit(true)
    }

    /// The first line of its output that is an error of Yosys or nextpnr.
    pub fn error(&self) -> Option<&str> {
        self.output.lines().find(|line| line.contains("ERROR: "))
    }
}

impl Tool {
    /// Returns whether it is on the PATH.
    pub fn is_installed(&self) -> bool {
        let Some(path) = std::env::var_os("PATH") else { return false };
        std::env::split_paths(&path).any(|it| it.join(self.program).is_file())
    }

    /// Checks that it is on the PATH.
    ///
    /// # Errors
    /// When it is not, with the command that installs it.
    pub fn check_is_installed(&self) -> Result<()> {
        if self.is_installed() { Ok(()) } else { Err(self.missing()) }
    }

    fn missing(&self) -> Error {
        let expected = format!("not found on PATH; install it: apt-get install {}", self.package);
        Input::new(self.program, expected).into()
    }

    /// Runs it in `folder` until it ends or its time is up; then it is killed with its children.
    ///
    /// # Errors
    /// When it is not on the PATH, cannot be started, or the user stops everything.
    pub fn run<A: AsRef<OsStr>>(
        &self,
        folder: &Path,
        args: impl IntoIterator<Item = A>,
        limits: &Limits,
    ) -> Result<Finished> {
        let mut command = Command::new(self.program);
        command.args(args);
        run(command, folder, limits).map_err(|error| match error {
            Error::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                self.missing()
            }
            error => error,
        })
    }
}

/// Runs a command as [`Tool::run`] does.
///
/// # Errors
/// When it cannot be started, or the user stops everything.
pub fn run(mut command: Command, folder: &Path, limits: &Limits) -> Result<Finished> {
    let program = command.get_program().to_owned();
    let fault = |source| Error::Io { path: program.clone().into(), action: "run", source };
    let out = tempfile::tempfile().map_err(fault)?;
    let both = |file: &File| Ok(Stdio::from(file.try_clone()?));
    command.current_dir(folder).stdin(Stdio::null());
    // What it leaves when it is killed goes with the folder.
    command.env("TMPDIR", std::path::absolute(folder).map_err(fault)?);
    command.stdout(both(&out).map_err(fault)?).stderr(both(&out).map_err(fault)?);
    let mut child =
        CommandWrap::from(command).wrap(ProcessGroup::leader()).spawn().map_err(fault)?;
    let (id, mut watch) = (child.id(), Watch::new(limits));
    let mut nap = NAP.0;
    let end = loop {
        if let Some(status) = child.try_wait().map_err(fault)? {
            break End::Exit(status.success());
        }
        poll_stop(limits.stop).inspect_err(|_| kill(child.as_mut()))?;
        if let Some(reason) = watch.look(id, out.metadata().map_or(0, |file| file.len())) {
            kill(child.as_mut());
            break reason;
        }
        sleep(nap);
        nap = (nap * 2).min(NAP.1);
    };
    Ok(Finished { end, output: text(out).map_err(fault)? })
}

/// Ends a program and its children; one that has just ended by itself is as good.
fn kill(child: &mut dyn ChildWrapper) {
    let _ = child.start_kill();
    let _ = child.wait();
}

fn text(mut file: File) -> std::io::Result<String> {
    use std::io::{Seek, SeekFrom};
    file.seek(SeekFrom::Start(0))?;
    let mut bytes = Vec::new();
    file.take(LONGEST).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;
    use std::time::Instant;

    fn limits(seconds: f64) -> Limits<'static> {
        Limits::new(Duration::from_secs_f64(seconds))
    }

    #[test]
    fn output_and_status_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let script = ["-c", "echo out; echo err >&2; exit 3"];
        let finished = SHELL.run(folder.path(), script, &limits(60.0)).unwrap();
        assert_eq!(finished.output, "out\nerr\n");
        assert_eq!(finished.end, End::Exit(false));
    }

    #[test]
    fn a_program_that_never_ends_is_killed_with_its_children() {
        let folder = tempfile::tempdir().unwrap();
        let child = "sh -c 'echo $$ > pid; exec sleep 60' & echo begun; sleep 60; true";
        let finished = SHELL.run(folder.path(), ["-c", child], &limits(0.25)).unwrap();
        assert_eq!(finished.end.killed().unwrap(), "has not ended after 2 s");
        assert_eq!(finished.output, "begun\n");
        let pid = std::fs::read_to_string(folder.path().join("pid")).unwrap();
        let lives = || {
            let stat = std::fs::read_to_string(format!("/proc/{}/stat", pid.trim()));
            stat.is_ok_and(|stat| !stat.contains(") Z"))
        };
        // The signal has been sent; a busy machine takes its time to act on it.
        let sent = Instant::now();
        while lives() && sent.elapsed() < Duration::from_secs(20) {
            sleep(NAP.1);
        }
        assert!(!lives(), "a child is left");
    }

    #[test]
    fn what_it_and_its_children_use_of_a_processor_counts_and_waiting_does_not() {
        let folder = tempfile::tempdir().unwrap();
        let run = |script| SHELL.run(folder.path(), ["-c", script], &limits(0.5)).unwrap();
        assert!(run("sleep 1.5").success());
        for script in ["while :; do :; done", "sh -c 'while :; do :; done' & sleep 60; true"] {
            let why = run(script).end.killed().unwrap();
            assert_eq!(why, "has not ended after 0.5 s of processor time", "{script}");
        }
    }

    #[test]
    fn a_program_that_says_nothing_for_too_long_is_killed() {
        let folder = tempfile::tempdir().unwrap();
        let silence = Some(Duration::from_secs(1));
        let limits = Limits { silence, ..limits(60.0) };
        for end in ["sleep 60", "while :; do :; done"] {
            let script = format!("for k in 1 2 3 4; do echo $k; sleep 0.4; done; {end}");
            let finished = SHELL.run(folder.path(), ["-c", &script], &limits).unwrap();
            assert_eq!(finished.end, End::Stalled(Duration::from_secs(1)), "{end}");
            assert_eq!(finished.output, "1\n2\n3\n4\n");
        }
    }

    #[test]
    fn a_missing_tool_is_named_with_its_package() {
        let tool = Tool { program: "no-such-simulator", package: "nothing" };
        let folder = tempfile::tempdir().unwrap();
        let error = tool.run(folder.path(), [""; 0], &limits(1.0)).unwrap_err();
        let expected = "no-such-simulator: not found on PATH; install it: apt-get install nothing";
        assert_eq!(error.to_string(), expected);
    }

    #[test]
    fn an_interruption_ends_the_program() {
        let folder = tempfile::tempdir().unwrap();
        let stop = AtomicBool::new(true);
        let limits = Limits { stop: Some(&stop), ..limits(60.0) };
        let error = SHELL.run(folder.path(), ["-c", "sleep 60"], &limits).unwrap_err();
        assert!(matches!(error, Error::Interrupted));
    }
}
