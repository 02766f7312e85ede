//! Tests of the default checks of `verify`, and of its report on missing coverage.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::common;

use super::OWN;

/// A folder with all of our Verilog, a text in one file replaced.
fn all(file: &str, old: &str, new: &str) -> tempfile::TempDir {
    let folder = common::empty();
    for entry in fs::read_dir(OWN).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|end| end == "v") {
            fs::copy(&path, folder.path().join(path.file_name().unwrap())).unwrap();
        }
    }
    let path = folder.path().join(file);
    let text = fs::read_to_string(&path).unwrap();
    assert_eq!(text.matches(old).count(), 1, "{old}");
    fs::write(path, text.replace(old, new)).unwrap();
    folder
}

/// The verdicts of blocks and what else they can be.
fn verdicts(folder: &Path, args: &[&str]) -> Vec<(String, String)> {
    let output = common::output(folder, &[&["verify", "--rtl", ".", "--json"], args].concat());
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let blocks = report["blocks"].as_array().unwrap().iter();
    blocks.map(|block| (text(&block["block"]), text(&block["verdict"]))).collect()
}

fn of(list: &[(String, String)], name: &str) -> String {
    list.iter().find(|(block, _)| block == name).unwrap().1.clone()
}

#[test]
fn faults_that_only_another_configuration_shows_are_found() {
    let narrow = "input wire signed [ActivationBits-1:0] l1_out_15";
    let folder = all("forward2.v", narrow, "input wire signed [ActivationBits-2:0] l1_out_15");
    let both = ["depth_estimator.default", "depth_estimator.neurons_16"];
    let both = ["--block", both[0], "--block", both[1], "--cycles", "1000"];
    let list = verdicts(folder.path(), &both);
    assert_eq!(of(&list, "depth_estimator"), "pass");
    assert_eq!(of(&list, "depth_estimator.neurons_16"), "differs");

    let started = "algo_start && Centroid)";
    let folder = all("tof_top.v", started, "algo_start || Centroid)");
    let both = ["--block", "tof_top.default", "--block", "tof_top.centroid", "--cycles", "1000"];
    let list = verdicts(folder.path(), &both);
    assert_eq!(of(&list, "tof_top"), "pass");
    assert_eq!(of(&list, "tof_top.centroid"), "differs");
}

#[test]
fn outputs_past_the_last_neuron_have_to_stay_0() {
    let folder = all("tansig.v", "if (k >= Neurons) begin", "if (k > Neurons) begin");
    let args = ["verify", "--rtl", ".", "--block", "tansig", "--cycles", "100"];
    let output = common::output(folder.path(), &args);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("tansig: cycle 17, 143999 ps: l1_out_8 expected 0000, got zzzz"),
        "{text}"
    );
}

#[test]
fn what_a_design_cannot_be_is_not_run_and_no_fault() {
    let folder =
        all("estimator_ctrl.v", "// hidden neurons, 1 to 32", "// units of the hidden layer");
    let path = folder.path().join("estimator_ctrl.v");
    fs::write(&path, fs::read_to_string(&path).unwrap().replace("Neurons", "Units")).unwrap();
    let args = ["verify", "--rtl", ".", "--block", "estimator_ctrl", "--junit", "a.xml"];
    let output = common::output(folder.path(), &args);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{text}");
    let reason = "estimator_ctrl.neurons_31: module estimator_ctrl has no parameter Neurons";
    assert!(text.contains(reason), "{text}");
    assert!(fs::read_to_string(folder.path().join("a.xml")).unwrap().contains("<skipped"));
}

#[test]
fn goals_that_were_missed_are_said_beside_pass() {
    let folder = common::empty();
    let args = ["verify", "--block", "tdc.default", "--cycles", "300"];
    let text = common::stdout(folder.path(), &args);
    assert!(text.contains("pass, goals missed"), "{text}");
    assert!(text.contains("tdc: goals of the stimulus missed: taps of a hit ("), "{text}");
    let report = common::json(folder.path(), &[&args[..], &["--json"]].concat());
    assert!(report["blocks"][0]["goals"]["missed"].as_str().unwrap().contains("codes ("));
    assert!(!common::stdout(folder.path(), &args[..3]).contains("missed"));
}

#[test]
#[ignore = "long: ./check --full"]
fn a_design_that_hangs_is_said_to_once_and_within_a_minute() {
    let folder = all("carry_chain.v", "else high = middle;", "else high = high;");
    let begin = Instant::now();
    let blocks = ["--block", "carry_chain", "--block", "tdc", "--block", "tof_top"];
    let list = verdicts(folder.path(), &blocks);
    assert!(begin.elapsed() < Duration::from_secs(60), "{:?}", begin.elapsed());
    assert_eq!(of(&list, "carry_chain"), "hangs");
    assert!(
        list.iter().filter(|(name, _)| name != "carry_chain").all(|(_, word)| word == "not run")
    );
    assert!(["tdc", "tof_top"].iter().all(|&block| of(&list, block) == "not run"));
}
