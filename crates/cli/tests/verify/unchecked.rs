//! Blocks that cannot be checked, beside others that can.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Output;

use serde_json::Value;

use crate::common;

use super::counter;

/// Verifies three blocks, of which ours are copied beside the counter in `folder`; each compilation in Icarus runs
/// `script` first.
fn verify(folder: &Path, script: &str, args: &[&str]) -> Output {
    let blocks = ["coarse_counter", "control_sync", "reset_sync"];
    for block in &blocks[1..] {
        let file = format!("{block}.v");
        fs::copy(Path::new(super::OWN).join(&file), folder.join(&file)).unwrap();
    }
    let tools = folder.join("tools");
    fs::create_dir_all(&tools).unwrap();
    let path = std::env::var("PATH").unwrap();
    let program = tools.join("iverilog");
    fs::write(&program, format!("#!/bin/sh\n{script}\nPATH='{path}' exec iverilog \"$@\"\n"))
        .unwrap();
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let mut words = vec!["verify", "--rtl", ".", "--cycles", "500"];
    words.extend(blocks.iter().flat_map(|block| ["--block", block]));
    words.extend(args);
    let mut command = common::tofsim(folder, &words);
    command.env("PATH", format!("{}:{path}", tools.display())).output().unwrap()
}

fn verdicts(output: &Output) -> Vec<Value> {
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["passed"], false);
    report["blocks"].as_array().unwrap().iter().map(|block| block["verdict"].clone()).collect()
}

/// A compilation of the counter that never ends.
const ENDLESS: &str = "case \"$*\" in *tb_coarse*) while :; do :; done;; esac";

#[test]
fn a_compilation_that_takes_too_long_leaves_the_other_blocks_to_be_checked() {
    let folder = counter("", "");
    let args = ["--time-limit", "1", "--json", "--junit", "a.xml"];
    let output = verify(folder.path(), ENDLESS, &args);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert_eq!(verdicts(&output), ["not checked", "pass", "not run", "pass"]);
    let reason = "compilation has not ended after 1 s of processor time (--time-limit)";
    assert!(
        error.contains("coarse_counter: not checked: .: ") && error.contains(reason),
        "{error}"
    );
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(report["blocks"][0]["fault"].as_str().unwrap().contains(reason), "{report}");
    let xml = fs::read_to_string(folder.path().join("a.xml")).unwrap();
    assert!(xml.contains("errors=\"1\"") && xml.contains("<error message="), "{xml}");
    let table = verify(folder.path(), ENDLESS, &["--time-limit", "1"]).stdout;
    assert!(String::from_utf8(table).unwrap().contains("not checked"));
}

#[test]
fn a_block_that_differs_decides_the_status_whatever_could_not_be_checked() {
    let folder = counter("", "");
    let script = format!(
        "{ENDLESS}\nsed -i 's/mode_sync <= mode_meta/mode_sync <= mode/' {}",
        folder.path().join("control_sync.v").display()
    );
    let output = verify(folder.path(), &script, &["--time-limit", "1", "--json"]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert_eq!(verdicts(&output), ["not checked", "differs", "not run", "pass"]);
    assert!(error.contains("coarse_counter: not checked"), "{error}");
}

#[test]
fn waiting_for_a_busy_machine_is_not_counted() {
    let folder = counter("", "");
    let output = verify(folder.path(), "sleep 2", &["--time-limit", "1"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn faults_of_several_blocks_are_all_said() {
    let folder = counter("window", "windo");
    let output =
        verify(folder.path(), "case \"$*\" in *tb_reset_sync*) exit 1;; esac", &["--json"]);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert_eq!(verdicts(&output), ["not checked", "pass", "not run", "not checked"]);
    for fault in
        ["coarse_counter: not checked: .: module coarse_counter, port window", "reset_sync: not"]
    {
        assert!(error.contains(fault), "{error}");
    }
}
