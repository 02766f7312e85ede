//! Interrupted and killed programs.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::common::{empty, files, refused, short_run, stdout, tofsim};

fn begin(folder: &Path, args: &[&str]) -> Child {
    tofsim(folder, args).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// Waits until something is there.
fn wait_for(there: impl Fn() -> bool) {
    let begun = Instant::now();
    while !there() {
        assert!(begun.elapsed() < Duration::from_secs(60), "it never comes");
        sleep(Duration::from_millis(2));
    }
}

#[cfg(unix)]
fn interrupt(mut child: Child) {
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(sent.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
}

#[cfg(unix)]
#[test]
fn an_interruption_leaves_nothing_of_vectors_and_captures() {
    let commands: [&[&str]; 2] = [
        &["vectors", "all", "-o", "out", "--cycles", "1000000"],
        &[
            "ila",
            "capture",
            "--probes",
            "fig_6_6",
            "-o",
            "out",
            "--trigger",
            "start falling && start",
        ],
    ];
    for (k, args) in commands.into_iter().enumerate() {
        let folder = empty();
        let many = [args, if k == 1 { &["--frames", "100000"] } else { &[] }].concat();
        let child = begin(folder.path(), &many);
        match k {
            0 => wait_for(|| !files(folder.path()).is_empty()),
            _ => sleep(Duration::from_millis(500)),
        }
        interrupt(child);
        assert_eq!(files(folder.path()), [""; 0], "{args:?}");
    }
}

#[cfg(unix)]
#[test]
fn an_interruption_leaves_nothing_of_a_comparison() {
    let folder = empty();
    let path = folder.path();
    stdout(path, &["run", "-o", ".", "--window", "shot:0..5000", "--frames", "1"]);
    let before = files(path);
    let compare = ["compare", "--scenario", "kc705", "kc705.vcd", "--waves", "both.vcd"];
    let child = begin(path, &[&compare[..], &["--frames", "1000"]].concat());
    wait_for(|| files(path).len() > before.len());
    interrupt(child);
    assert_eq!(files(path), before);
}

#[cfg(unix)]
#[test]
fn what_a_killed_run_left_goes_with_the_next_run() {
    let folder = empty();
    let path = folder.path();
    let mut child = begin(path, &["run", "--frames", "100000", "--events", "shots.csv"]);
    let parts = |of: &Path| files(of).iter().filter(|name| name.ends_with(".part")).count();
    wait_for(|| parts(path) > 0 && parts(&path.join("waves")) > 0);
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(parts(path) > 0 && parts(&path.join("waves")) > 0);
    // A run that goes on keeps what it has under construction.
    let mut other = begin(path, &["run", "--frames", "100000", "--events", "other.csv", "-o", "o"]);
    wait_for(|| parts(&path.join("o")) > 0 && parts(path) > 0);
    stdout(path, &short_run(&["--events", "shots.csv"]));
    assert_eq!((parts(path), parts(&path.join("waves"))), (1, 0));
    assert!(path.join("shots.csv").is_file());
    other.kill().unwrap();
    other.wait().unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn simulators_of_a_killed_run_go_with_the_next_run() {
    let folder = empty();
    let (path, scratch) = (folder.path(), folder.path().join("tmp"));
    fs::create_dir(&scratch).unwrap();
    let verify = |args: &[&str]| {
        let mut command = tofsim(path, &[&["verify", "--block"], args].concat());
        command.env("TMPDIR", &scratch).stdout(Stdio::null()).stderr(Stdio::null());
        command
    };
    let simulators = || {
        let processes = fs::read_dir("/proc").unwrap().flatten().map(|process| process.path());
        let is_one = |process: &PathBuf| {
            let runs = fs::read_to_string(process.join("comm")).is_ok_and(|name| name == "vvp\n");
            let at = fs::read_link(process.join("cwd")).unwrap_or_default();
            runs && at.to_string_lossy().contains(scratch.to_str().unwrap())
        };
        processes.filter(is_one).count()
    };
    let mut child = verify(&["depth_estimator.default", "--cycles", "40000"]).spawn().unwrap();
    wait_for(|| simulators() > 0);
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(simulators() > 0 && !files(&scratch).is_empty());
    assert!(verify(&["pll"]).status().unwrap().success());
    // By itself it would take much longer.
    sleep(Duration::from_millis(200));
    assert_eq!(simulators(), 0);
    assert_eq!(files(&scratch), [""; 0]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_training_goes_on_where_it_was() {
    let folder = empty();
    let path = folder.path();
    let stages = "stages=[{candidates=4,epochs=400,samples=2010}]";
    let train =
        ["train", "--quick", "--with", stages, "--with", "checkpoint_epochs=400", "-o", "t"];
    let child = begin(path, &train);
    wait_for(|| path.join("t").is_dir());
    sleep(Duration::from_secs(3));
    interrupt(child);
    assert_eq!(files(&path.join("t")), ["checkpoint"], "long before the recipe's first checkpoint");
    let state = fs::read_to_string(path.join("t/checkpoint")).unwrap();
    assert!(state.contains("made = "), "{}", &state[..300]);
    let other = refused(path, &[&train[..], &["--resume", "--seed", "7"]].concat());
    assert!(other.contains("it was started with --seed 1, here it is --seed 7"), "{other}");
    let missing = refused(path, &["train", "--resume", "-o", "nowhere"]);
    assert!(missing.contains("nowhere/checkpoint: no checkpoint there"), "{missing}");
}
