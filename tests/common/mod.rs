//! What several tests share.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tofsim::network::Histogram;
use tofsim::scenario;
use tofsim::sim::Run;
use tofsim::sim::frames::Frame;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;

/// A scenario with overrides, ready to run.
pub fn setup(name: &str, overrides: &[&str]) -> Setup {
    let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
    Setup::new(scenario::load(name, &overrides).unwrap()).unwrap()
}

/// The first `count` frames of a setup.
pub fn frames(setup: &Setup, count: u64) -> Vec<Frame> {
    let mut frames = Vec::new();
    let mut take = |frame: &Frame| {
        frames.push(frame.clone());
        Ok(())
    };
    let watch = Observers { frames: Some(&mut take), ..Observers::default() };
    Run::new(setup).frames(count, watch).unwrap();
    assert_eq!(frames.len() as u64, count);
    frames
}

/// The program, to be run in `folder`.
pub fn tofsim(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tofsim"));
    command.current_dir(folder).args(args);
    command
}

/// What the program did.
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

/// Names of the files in a folder, hidden ones too.
pub fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .map(|entries| entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect())
        .unwrap_or_default();
    names.sort();
    names
}

/// A histogram as CSV with a comment.
pub fn csv(histogram: &Histogram) -> String {
    let mut text = String::from("# made by hand\nbin,count\n");
    for (bin, count) in histogram.iter().enumerate() {
        writeln!(text, "{bin},{count}").unwrap();
    }
    text
}

/// An `.npy` file of that type and shape, by the format's description.
pub fn npy(descr: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let dict = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    let header = format!("{dict:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
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

/// A folder with nothing in it, gone at the end of the test.
pub fn empty() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

/// The arguments of a run whose frame has 40 shots and so takes no time.
pub fn short_run<'a>(args: &[&'a str]) -> Vec<&'a str> {
    [&["run"], args, &["-s", "firmware.shots_per_frame=40"]].concat()
}
