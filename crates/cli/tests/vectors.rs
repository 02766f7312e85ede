//! `tofsim vectors`: the files that a user's own bench or simulator starts from.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use tofsim_rtl::golden::BLOCKS;

use crate::common;

const OWN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../rtl_ref");

fn vectors(folder: &Path, args: &[&str]) {
    common::stdout(folder, &[&["vectors"], args, &["-o", "."]].concat());
}

fn ports(folder: &Path, block: &str) -> Value {
    let text = fs::read_to_string(folder.join(block).join("ports.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Sum of the widths of the columns.
fn width(columns: &Value) -> usize {
    columns.as_array().unwrap().iter().map(|c| c["width"].as_u64().unwrap() as usize).sum()
}

#[test]
fn all_writes_a_folder_for_each_block_with_lines_as_wide_as_their_columns() {
    let folder = common::empty();
    vectors(folder.path(), &["all", "--cycles", "100"]);
    let names: Vec<_> = BLOCKS.iter().map(|spec| spec.name).collect();
    assert_eq!(common::files(folder.path()), names);
    for name in names {
        let files = common::files(&folder.path().join(name));
        for file in ["expected.mem", "ports.json", "stimulus.mem", &format!("tb_{name}.v")] {
            assert!(files.iter().any(|found| found == file), "{name} has no {file}");
        }
        let described = ports(folder.path(), name);
        for side in ["stimulus", "expected"] {
            let lines = folder.path().join(name).join(format!("{side}.mem"));
            let text = fs::read_to_string(lines).unwrap();
            assert_eq!(text.lines().count(), 100, "{name} {side}");
            let digits = width(&described[side]).div_ceil(4).max(1);
            assert!(text.lines().all(|line| line.len() == digits), "{name} {side}");
        }
    }
}

#[test]
fn the_estimator_and_the_converter_come_with_their_memories() {
    let folder = common::empty();
    vectors(folder.path(), &["depth_estimator", "--cycles", "10"]);
    vectors(folder.path(), &["tdc_decoder", "--cycles", "10"]);
    let lines = |file: &str| fs::read_to_string(folder.path().join(file)).unwrap().lines().count();
    for (file, count) in [("w1", 256), ("b1", 1), ("w2", 1), ("b2", 1), ("tansig", 4096)] {
        assert_eq!(lines(&format!("depth_estimator/{file}.mem")), count);
    }
    assert_eq!(lines("tdc_decoder/tdc_cal.mem"), 801);
}

#[test]
fn seeds_cycles_and_scenarios_decide_the_lines_and_the_same_ones_give_the_same() {
    let lines = |args: &[&str]| {
        let folder = common::empty();
        vectors(folder.path(), &[&["tof_top", "--cycles", "400"], args].concat());
        let read = |name| fs::read_to_string(folder.path().join("tof_top").join(name)).unwrap();
        read("stimulus.mem") + &read("expected.mem") + &read("tb_tof_top.v") + &read("tdc_stop.mem")
    };
    assert_eq!(lines(&[]), lines(&[]));
    assert_ne!(lines(&[]), lines(&["--seed", "2"]));
    assert_ne!(lines(&[]), lines(&["--scenario", "near"]));
    assert_ne!(lines(&["--scenario", "near"]), lines(&["-s", "target.distance_m=0.2"]));
}

#[test]
fn a_configuration_has_a_folder_with_its_bench() {
    let folder = common::empty();
    vectors(folder.path(), &["tdc.leading", "--cycles", "10"]);
    let bench = fs::read_to_string(folder.path().join("tdc.leading/tb_tdc.v")).unwrap();
    assert!(bench.contains(".Decoder(1)"), "{bench}");
    let refused = |args: &[&str]| common::refused(folder.path(), &[&["vectors"], args].concat());
    let unknown = refused(&["tdc.middle", "-o", "."]);
    assert!(unknown.contains("expected one of default, "), "{unknown}");
    let twice = refused(&["tdc.leading", "--scenario", "near", "-o", "."]);
    assert!(twice.contains("expected no configuration"), "{twice}");
}

#[test]
fn outputs_past_the_last_neuron_are_checked_in_a_design_that_has_them() {
    let folder = common::empty();
    vectors(folder.path(), &["tansig", "--rtl", OWN, "--cycles", "10"]);
    let bench = fs::read_to_string(folder.path().join("tansig/tb_tansig.v")).unwrap();
    assert!(bench.contains("wire past = |{l1_out_8, "), "{bench}");
}

#[test]
fn a_bench_runs_by_hand_as_the_documents_say() {
    let folder = common::empty();
    vectors(folder.path(), &["forward2", "--cycles", "500"]);
    let command = format!(
        "cd forward2 && iverilog -g2005 -Wall -s tb_forward2 -o tb tb_forward2.v {OWN}/forward2.v && vvp tb"
    );
    let run = || Command::new("sh").args(["-c", &command]).current_dir(folder.path()).output();
    let output = run().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    // Our own Verilog has ports for more neurons, which the bench of eight leaves open.
    let warnings = String::from_utf8_lossy(&output.stderr).into_owned();
    let is_past = |line: &str| line.contains("dangling input port") && line.contains("(l1_out_");
    assert!(warnings.lines().all(is_past) && warnings.lines().count() == 24, "{warnings}");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("tb_forward2: PASS, 500 cycles, 0 mismatches"), "{text}");

    let expected = folder.path().join("forward2/expected.mem");
    let lines = fs::read_to_string(&expected).unwrap();
    let mut lines: Vec<_> = lines.lines().map(str::to_owned).collect();
    lines[77] = lines[77].chars().rev().collect();
    fs::write(&expected, lines.join("\n")).unwrap();
    let output = run().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(!output.status.success(), "{text}");
    assert!(text.contains("mismatch: cycle 77, time 623999 ps, depth: expected "), "{text}");
    assert!(text.contains("tb_forward2: FAIL, 500 cycles, 1 mismatches"), "{text}");
}

#[test]
fn what_there_is_not_is_refused() {
    let folder = common::empty();
    let refused = |args: &[&str]| {
        let args = [&["vectors"], args, &["-o", "out"]].concat();
        let error = common::refused(folder.path(), &args);
        assert!(common::files(folder.path()).is_empty(), "{args:?}");
        error
    };
    let error = refused(&["tdc_decodr"]);
    assert!(error.contains("did you mean tdc_decoder?"), "{error}");
    refused(&["tdc", "--cycles", "0"]);
    refused(&["tdc", "--scenario", "nowhere"]);
    let error = refused(&["tof_top", "-s", "pll.lock_time_us=1.0000001"]);
    assert!(error.contains("expected whole picoseconds"), "{error}");
    let endless = ["-s", "firmware.dsp_en=false", "-s", "firmware.shots_per_frame=40"];
    let error = refused(&[&["tof_top"], &endless[..]].concat());
    assert!(error.contains("never ends"), "{error}");
}

#[test]
fn a_bench_for_a_design_of_other_names_comes_with_what_lies_between() {
    const THEIRS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/verilog/array_port");
    let folder = common::empty();
    let map = format!("{THEIRS}/map.toml");
    vectors(
        folder.path(),
        &["histogram_builder", "--cycles", "900", "--rtl", THEIRS, "--map", &map],
    );
    let files = common::files(&folder.path().join("histogram_builder"));
    assert!(files.contains(&"histogram_builder_adapter.v".to_owned()), "{files:?}");
    let simulators = [
        "iverilog -g2012 -s tb_histogram_builder -o tb *.v",
        "verilator --binary --timing -Wno-fatal -Wno-lint -o ../tb --top-module tb_histogram_builder *.v",
    ];
    for (compile, run) in simulators.into_iter().zip(["vvp tb", "./tb"]) {
        let command = format!("cd histogram_builder && {compile} {THEIRS}/histogram.sv && {run}");
        let output = Command::new("sh").args(["-c", &command]).current_dir(folder.path()).output();
        let output = output.unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let pass = "tb_histogram_builder: PASS, 900 cycles, 0 mismatches";
        assert!(text.contains(pass), "{text}{}", String::from_utf8_lossy(&output.stderr));
    }
    let all = ["vectors", "histogram_builder", "--map", &map, "-o", "a"];
    assert!(common::refused(folder.path(), &all).contains("--rtl"));
}
