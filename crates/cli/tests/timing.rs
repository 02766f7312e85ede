//! `tofsim timing`, with a nextpnr that always says the same: what it measures is not tested here.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;

use tofsim_rtl::timing::nextpnr::NEXTPNR;

use crate::common;

/// A folder with a nextpnr in `bin` that reports so many MHz, or with none.
fn folder(mhz: Option<f64>) -> tempfile::TempDir {
    let folder = common::empty();
    let bin = folder.path().join("bin");
    fs::create_dir(&bin).unwrap();
    if let Some(mhz) = mhz {
        let script = format!(
            "#!/bin/sh\n\
             case $1 in --version) echo 'nextpnr-ecp5 -- made up (Version 0)'; exit;; esac\n\
             while [ $1 != --report ]; do shift; done\n\
             echo '{{\"fmax\": {{\"clk_sys\": {{\"achieved\": {mhz}}}}}, \"utilization\": {{}}, \
             \"critical_paths\": []}}' > $2\n"
        );
        let path = bin.join("nextpnr-ecp5");
        fs::write(&path, script).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }
    folder
}

/// Times a small block with no other nextpnr on the PATH than the folder's own.
fn timing(folder: &Path, args: &[&str]) -> Output {
    let path = std::env::var_os("PATH").unwrap();
    let is_without = |it: &PathBuf| NEXTPNR.iter().all(|tool| !it.join(tool.program).exists());
    let others = std::env::split_paths(&path).filter(is_without);
    let path = std::env::join_paths([folder.join("bin")].into_iter().chain(others)).unwrap();
    let block = ["timing", "--block", "vcsel_driver"];
    common::tofsim(folder, &[&block[..], args].concat()).env("PATH", path).output().unwrap()
}

fn error(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn without_nextpnr_there_is_an_estimate_and_a_note_or_a_refusal() {
    let folder = folder(None);
    let output = timing(folder.path(), &["--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", error(&output));
    assert!(error(&output).contains("nextpnr-ecp5: not found on PATH"), "{}", error(&output));
    let timed: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(timed["schema"], "tofsim.timing/1");
    let block = &timed["blocks"]["vcsel_driver"];
    assert!(block["ecp5"].is_null() && block["kintex7"]["ns"][1].as_f64() > Some(2.0), "{timed}");
    let output = timing(folder.path(), &["--part", "ecp5"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(error(&output).contains("install it: pip install"), "{}", error(&output));
}

#[test]
fn a_clock_that_is_too_slow_has_status_1() {
    for (mhz, status) in [(125.0, 0), (124.9, 1)] {
        let folder = folder(Some(mhz));
        let output = timing(folder.path(), &["--part", "ecp5"]);
        assert_eq!(output.status.code(), Some(status), "{}", error(&output));
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains(&format!(" {mhz:.1} ")), "{text}");
    }
}

#[test]
fn what_is_recorded_of_the_same_netlist_is_not_measured_again() {
    let folder = folder(Some(130.0));
    let path = folder.path().join("timing.json");
    let record = ["--part", "ecp5", "--record", "timing.json", "--seeds"];
    for (seeds, again) in [("2", false), ("2", true), ("1", true), ("3", false)] {
        let output = timing(folder.path(), &[&record[..], &[seeds]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", error(&output));
        assert_eq!(error(&output).contains("the same netlist as in the record"), again, "{seeds}");
    }
    let text = fs::read_to_string(&path).unwrap();
    let recorded: Value = serde_json::from_str(&text).unwrap();
    let clock = &recorded["blocks"]["vcsel_driver"]["ecp5"]["clocks"]["clk_sys"];
    assert_eq!(clock["mhz"].as_array().unwrap().len(), 3);
    fs::write(&path, &text[..text.len() / 2]).unwrap();
    let output = timing(folder.path(), &[&record[..], &["1"]].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(error(&output).contains("timing.json: expected a record"), "{}", error(&output));
    assert_eq!(fs::read_to_string(&path).unwrap(), text[..text.len() / 2]);
}

#[test]
fn what_cannot_be_timed_is_refused() {
    let folder = common::empty();
    fs::write(folder.path().join("a.v"), "module a(input wire clk);\nendmodule\n").unwrap();
    let refused = |args: &[&str]| common::refused(folder.path(), &[&["timing"], args].concat());
    assert!(refused(&["--block", "tdd"]).contains("tdd: no such block (`tdc`?)"));
    assert!(refused(&["--rtl", "a.v"]).contains("expected one of the modules depth_estimator"));
    assert!(refused(&["--rtl", "nowhere"]).contains("nowhere"));
    assert!(refused(&["--seeds", "0"]).contains("--seeds"));
}
