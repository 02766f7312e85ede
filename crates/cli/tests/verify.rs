//! `tofsim verify` on other people's Verilog: what differs is found and shown, what cannot be checked
//! is refused with the reason.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde_json::Value;

use crate::common;

mod cycle_counts;
mod early;
mod foreign;
mod inputs;
mod sources;
mod stranger;
#[cfg(unix)]
mod unchecked;
mod whole;

const OWN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../rtl_ref");
const THEIRS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/verilog");

/// A folder with our coarse counter alone, a text in it replaced.
fn counter(old: &str, new: &str) -> tempfile::TempDir {
    let folder = common::empty();
    let text = fs::read_to_string(Path::new(OWN).join("coarse_counter.v")).unwrap();
    assert!(text.contains(old), "{old} is not in coarse_counter.v");
    fs::write(folder.path().join("coarse_counter.v"), text.replace(old, new)).unwrap();
    folder
}

/// A folder with our Verilog, but for those files.
fn own(but: &[&str]) -> tempfile::TempDir {
    let folder = common::empty();
    let ours = common::files(Path::new(OWN)).into_iter();
    for name in ours.filter(|name| name.ends_with(".v") && !but.contains(&name.as_str())) {
        fs::copy(Path::new(OWN).join(&name), folder.path().join(&name)).unwrap();
    }
    folder
}

fn verify(folder: &Path, args: &[&str]) -> std::process::Output {
    let all = ["verify", "--rtl", ".", "--block", "coarse_counter"];
    common::output(folder, &[&all[..], args].concat())
}

fn refused(folder: &Path, args: &[&str]) -> String {
    let output = verify(folder, args);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(!error.contains("panicked"), "{error}");
    error
}

fn map(name: &str, block: &str, simulator: &str) {
    let folder = common::empty();
    let theirs = PathBuf::from(THEIRS).join(name);
    let theirs = theirs.to_str().unwrap();
    let map = format!("{theirs}/map.toml");
    let args = ["verify", "--rtl", theirs, "--map", &map, "--block", block];
    let how = ["--json", "--cycles", "20000", "--simulator", simulator];
    let report = common::json(folder.path(), &[&args[..], &how].concat());
    assert_eq!(report["passed"], true, "{report}");
    assert_eq!(report["blocks"][0]["cycles"], 20_000);
}

#[test]
fn the_first_mismatch_is_the_same_in_both_simulators_and_in_table_json_and_xml() {
    let folder = counter("coarse + 1'b1", "coarse + 2'd2");
    let first = |simulator: &str| -> Value {
        let output =
            verify(folder.path(), &["--json", "--junit", "a.xml", "--simulator", simulator]);
        assert_eq!(output.status.code(), Some(1));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(report["passed"], false);
        report["blocks"][0].clone()
    };
    let icarus = first("icarus");
    assert_eq!(icarus, first("verilator"));
    assert_eq!(icarus["first"]["signal"], "coarse");
    let cycle = icarus["first"]["cycle"].as_u64().unwrap();

    let text = String::from_utf8(verify(folder.path(), &[]).stdout).unwrap();
    assert!(text.contains(&format!("cycle {cycle}, ")), "{text}");
    assert!(text.contains(&format!("{cycle} *")), "{text}");
    assert!(text.contains("coarse  expected") && text.contains("coarse  got"), "{text}");
    let xml = fs::read_to_string(folder.path().join("a.xml")).unwrap();
    assert!(xml.contains("failures=\"1\"") && xml.contains("coarse expected"), "{xml}");
}

#[test]
fn with_fail_fast_nothing_comes_after_the_first_mismatch() {
    let folder = counter("coarse + 1'b1", "coarse + 2'd2");
    fs::copy(Path::new(OWN).join("control_sync.v"), folder.path().join("control_sync.v")).unwrap();
    let args = ["verify", "--rtl", ".", "--json", "-o", "out"];
    let args = [&args[..], &["--block", "coarse_counter", "--block", "control_sync"]].concat();
    let blocks = |args: &[&str]| -> [Value; 2] {
        let mut command = common::tofsim(folder.path(), args);
        let output = command.env("RAYON_NUM_THREADS", "1").output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        [0, 1].map(|n| report["blocks"][n].clone())
    };
    let first = blocks(&[&args[..], &["--fail-fast"]].concat());
    assert!(!folder.path().join("out").exists());
    let all = blocks(&args);
    assert_eq!(first[0]["first"], all[0]["first"]);
    assert_eq!(first[0]["mismatches"], 1);
    assert!(all[0]["mismatches"].as_u64() > Some(1));
    assert_eq!([&first[1]["verdict"], &all[1]["verdict"]], ["not run", "pass"]);
}

#[test]
fn the_waveform_of_a_mismatch_has_both_sides() {
    let folder = counter("coarse + 1'b1", "coarse + 2'd2");
    verify(folder.path(), &["-o", "out"]);
    assert_eq!(
        common::files(&folder.path().join("out")),
        ["coarse_counter.gtkw", "coarse_counter.vcd"]
    );
    let mut wave = wellen::simple::read(folder.path().join("out/coarse_counter.vcd")).unwrap();
    let mut values = |side: &str| {
        let path = ["tb_coarse_counter", side];
        let signal = wave.hierarchy().lookup_var(&path, "coarse").unwrap();
        let signal = wave.hierarchy()[signal].signal_ref();
        wave.load_signals(&[signal]);
        let signal = wave.get_signal(signal).unwrap();
        signal.iter_changes().take(4).map(|(_, value)| value.to_string()).collect::<Vec<_>>()
    };
    assert_eq!(values("expected"), ["000", "001", "010", "011"]);
    assert_eq!(values("got"), ["000", "010", "100", "110"]);
}

#[test]
fn a_design_with_other_names_polarities_and_latency_passes_through_a_map() {
    map("renamed", "coarse_counter", "icarus");
    map("renamed", "coarse_counter", "verilator");
}

#[test]
fn a_histogram_of_parallel_counts_passes_through_its_adapter() {
    map("parallel_counts", "histogram_builder", "icarus");
}

#[test]
fn an_estimator_fed_a_vector_passes_through_its_adapter() {
    map("vector", "depth_estimator", "icarus");
}

#[test]
fn a_shorter_chain_passes_on_what_it_can_show() {
    map("short_chain", "tdc_latch", "icarus");
}

#[test]
fn a_wrong_latency_in_the_map_is_found() {
    let folder = common::empty();
    let text = fs::read_to_string(format!("{THEIRS}/renamed/map.toml")).unwrap();
    fs::write(folder.path().join("map.toml"), text.replace("coarse = 1", "coarse = 2")).unwrap();
    let theirs = format!("{THEIRS}/renamed");
    let args = ["verify", "--rtl", &theirs, "--map", "map.toml", "--block", "coarse_counter"];
    assert_eq!(common::output(folder.path(), &args).status.code(), Some(1));
}

#[test]
fn a_syntax_error_is_shown_as_the_simulator_says_it() {
    let folder = counter("always @*", "always @*(");
    let error = refused(folder.path(), &[]);
    assert!(error.contains("coarse_counter.v:24: syntax error"), "{error}");
    assert!(refused(folder.path(), &["--simulator", "verilator"]).contains("syntax error"));
}

#[test]
fn a_missing_module_or_port_and_a_wrong_width_are_named() {
    for simulator in ["icarus", "verilator"] {
        let in_it = ["--simulator", simulator];
        let folder = counter("module coarse_counter", "module coarse_count");
        let error = refused(folder.path(), &in_it);
        assert!(error.contains("coarse_counter: no such module"), "{error}");
        let folder = counter("window", "windo");
        let error = refused(folder.path(), &in_it);
        let ports = "no such port (`windo`?); it has clk_sys, coarse, rst, start, windo";
        assert!(error.contains(ports), "{error}");
        let folder =
            counter("output reg [CoarseBits-1:0] coarse", "output reg [CoarseBits:0] coarse");
        let error = refused(folder.path(), &in_it);
        assert!(error.contains("port coarse: has 4 bits, expected 3"), "{error}");
    }
}

#[test]
fn a_design_with_the_estimator_of_the_thesis_only_is_checked_without_the_other() {
    let folder = own(&["centroid_estimator.v", "likelihood_estimator.v"]);
    let top = folder.path().join("tof_top.v");
    let text = fs::read_to_string(&top).unwrap();
    let (before, instance) = text.split_once("    centroid_estimator #(").unwrap();
    assert_eq!(instance.matches(");\n").count(), 5, "the other two, and those of a host");
    let (_, host) = instance.split_once("    uart_bridge #(").unwrap();
    fs::write(&top, format!("{before}    uart_bridge #({host}")).unwrap();

    let checked = |args: &[&str]| {
        let all = ["verify", "--rtl", ".", "--json", "--cycles", "500"];
        let output = common::output(folder.path(), &[&all[..], args].concat());
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{error}");
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        let blocks = report["blocks"].as_array().unwrap().iter();
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        let verdicts = blocks.map(|block| (text(&block["block"]), text(&block["verdict"])));
        (verdicts.collect::<BTreeMap<_, _>>(), error)
    };
    // With a key, blocks are not checked in their other configurations.
    let (verdicts, error) = checked(&["-s", "seed=1"]);
    assert!(error.contains("no such module: centroid_estimator"), "{error}");
    assert_eq!(verdicts["tof_top"], "pass");
    assert!(!verdicts.contains_key("centroid_estimator"), "{verdicts:?}");
    let (verdicts, _) = checked(&["--block", "tof_top.likelihood"]);
    assert_eq!(verdicts["tof_top.likelihood"], "not run");

    let asked = ["verify", "--rtl", ".", "--block", "centroid_estimator"];
    let error = common::refused(folder.path(), &asked);
    assert!(error.contains("centroid_estimator: no such module"), "{error}");
}

#[test]
fn a_map_that_names_an_unknown_port_is_refused_with_its_place() {
    let folder = counter("", "");
    fs::write(folder.path().join("map.toml"), "[block.coarse_counter.ports]\nstrat = \"go\"\n")
        .unwrap();
    let error = refused(folder.path(), &["--map", "map.toml"]);
    assert!(error.contains("map.toml:2:"), "{error}");
    assert!(error.contains("unknown port (`start`?)"), "{error}");
    fs::write(folder.path().join("map.toml"), "[block.coarse_counter.ports]\nstart = \"go\"\n")
        .unwrap();
    let error = refused(folder.path(), &["--map", "map.toml"]);
    assert!(error.contains("port go: no such port"), "{error}");
}

#[test]
fn a_bench_that_never_ends_is_killed_at_its_time_limit() {
    let endless = "initial begin : hang\nreg level;\nforever level = 1'b1;\nend\nendmodule";
    let folder = counter("endmodule", endless);
    let begin = Instant::now();
    let output = verify(folder.path(), &["--time-limit", "1"]);
    assert!(begin.elapsed().as_secs() < 60);
    assert_eq!(output.status.code(), Some(1));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("has not ended after 1 s of processor time and was killed"), "{text}");
}

#[test]
fn a_missing_simulator_is_named_with_its_package() {
    let folder = counter("", "");
    for (simulator, package) in [("icarus", "iverilog"), ("verilator", "verilator")] {
        let args = ["verify", "--block", "coarse_counter", "--simulator", simulator];
        let output = common::tofsim(folder.path(), &args).env("PATH", "/nowhere").output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(error.contains(&format!("apt-get install {package}")), "{error}");
    }
}

#[cfg(unix)]
#[test]
fn file_names_need_not_be_utf_8() {
    use std::os::unix::ffi::OsStrExt;
    let folder = counter("", "");
    let odd = folder.path().join(std::ffi::OsStr::from_bytes(b"rtl \xff"));
    fs::create_dir(&odd).unwrap();
    fs::rename(folder.path().join("coarse_counter.v"), odd.join("coarse_counter.v")).unwrap();
    let mut command = common::tofsim(folder.path(), &["verify", "--block", "coarse_counter"]);
    let output = command.arg("--rtl").arg(&odd).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn what_cannot_be_asked_for_is_refused() {
    let folder = common::empty();
    let error = common::refused(folder.path(), &["verify", "--block", "coarse_countr"]);
    assert!(error.contains("did you mean coarse_counter?"), "{error}");
    let error = common::refused(folder.path(), &["verify", "--block", "tdc.trailing"]);
    assert!(error.contains("no such configuration of tdc; expected one of default"), "{error}");
    let told = ["verify", "--block", "tdc.leading", "-s", "tdc.count_stages=3"];
    let error = common::refused(folder.path(), &told);
    assert!(error.contains("tdc.leading") && error.contains("says what the block is"), "{error}");
    let error = common::refused(folder.path(), &["verify", "--rtl", "."]);
    assert!(error.contains("no .v, .sv, .vhd or .vhdl file"), "{error}");
    common::refused(folder.path(), &["verify", "--rtl", "none"]);
    common::refused(folder.path(), &["verify", "--time-limit", "0"]);
    let jitter = ["verify", "--top", "-s", "pll.jitter_rms_ps=7.7"];
    let error = common::refused(folder.path(), &jitter);
    assert!(error.contains("pll.jitter_rms_ps = 7.7"), "{error}");
}
