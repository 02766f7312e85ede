//! Shared helpers of the tests: the program, and those of the simulator's own tests.

#[path = "../../../tests/common.rs"]
mod simulator;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub use simulator::*;

/// The program, to be run in `folder`.
pub fn tofsim(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tofsim"));
    command.current_dir(folder).args(args);
    command
}

/// Runs the program.
pub fn output(folder: &Path, args: &[&str]) -> Output {
    tofsim(folder, args).output().unwrap()
}

/// Standard output of a run that has to succeed.
pub fn stdout(folder: &Path, args: &[&str]) -> String {
    let output = output(folder, args);
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Standard output of a run that has to succeed, as JSON.
pub fn json(folder: &Path, args: &[&str]) -> serde_json::Value {
    serde_json::from_str(&stdout(folder, args)).unwrap()
}

/// Standard error of a run that has to be refused with status 2, without a panic.
pub fn refused(folder: &Path, args: &[&str]) -> String {
    let output = output(folder, args);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {error}");
    assert!(!error.contains("panicked"), "{args:?}: {error}");
    error
}

/// Creates a folder with copies of some of the files that were read wrong once.
pub fn cases(names: &[&str]) -> tempfile::TempDir {
    let folder = empty();
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures/tests/cases");
    for name in names {
        fs::copy(from.join(name), folder.path().join(name)).unwrap();
    }
    folder
}

/// A device called `name` like `/dev/{name}`, in `folder` where the system lets us make one: a fault
/// in our own writing must not cost the machine its devices.
pub fn device(folder: &Path, name: &str) -> PathBuf {
    let own = folder.join(name);
    if own.exists() {
        return own;
    }
    let minor = if name == "full" { "7" } else { "3" };
    let made = std::process::Command::new("mknod")
        .args([own.as_os_str(), "c".as_ref(), "1".as_ref(), minor.as_ref()])
        .stderr(std::process::Stdio::null())
        .status();
    let usable = made.is_ok_and(|status| status.success())
        && fs::File::options().write(true).open(&own).is_ok();
    if usable { own } else { Path::new("/dev").join(name) }
}

/// The arguments of a run whose frame has 40 shots and so takes no time.
pub fn short_run<'a>(args: &[&'a str]) -> Vec<&'a str> {
    [&["run"], args, &["-s", "firmware.shots_per_frame=40"]].concat()
}
