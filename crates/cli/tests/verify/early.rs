//! Designs that are faster than ours.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common;

use super::{OWN, counter};

/// Our decoder with two pipeline stages less: nothing is registered between the taps and `n`.
fn decoder() -> tempfile::TempDir {
    let folder = common::empty();
    let text = fs::read_to_string(Path::new(OWN).join("tdc_decoder.v")).unwrap();
    let begin = text.find("        if (hit) begin\n            sixteens <=").unwrap();
    let end = text.find("        if (counted) begin").unwrap();
    let mut text = text[..begin].to_owned() + &text[end..];
    for (old, new) in [
        ("assign counted = hundreds_valid;", "assign counted = hit;"),
        ("{129 - 8 * Hundreds{1'b0}}, hundreds};", "{129 - 8 * Hundreds{1'b0}}, hundreds_next};"),
        ("assign counted_coarse = hundreds_coarse;", "assign counted_coarse = hit_coarse;"),
        ("5 * Sixteens{1'b0}}, sixteens};", "5 * Sixteens{1'b0}}, sixteens_next};"),
    ] {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    fs::write(folder.path().join("tdc_decoder.v"), text).unwrap();
    folder
}

fn verify(folder: &Path, block: &str, map: &str, args: &[&str]) -> (Option<i32>, Value, String) {
    fs::write(folder.join("map.toml"), format!("[block.{block}]\n{map}\n")).unwrap();
    let block = format!("{block}.default");
    let all = ["verify", "--rtl", ".", "--map", "map.toml", "--json", "--block", &block];
    let output = common::output(folder, &[&all[..], args].concat());
    let report: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
    (output.status.code(), report["blocks"][0].clone(), String::from_utf8(output.stderr).unwrap())
}

/// The vectors' first lines, which show what differs.
const SHORT: [&str; 2] = ["--cycles", "1000"];

/// Latencies of all outputs of the decoder.
fn all(clocks: i64) -> String {
    let names = ["tdc_valid", "tdc_code"];
    let each: Vec<_> = names.iter().map(|name| format!("{name} = {clocks}")).collect();
    format!("latency = {{ {} }}", each.join(", "))
}

#[test]
fn a_decoder_two_clocks_faster_passes() {
    let folder = decoder();
    for simulator in ["icarus", "verilator"] {
        let args = ["--cycles", "4000", "--simulator", simulator];
        let (status, block, error) = verify(folder.path(), "tdc_decoder", &all(-2), &args);
        assert_eq!((status, &block["verdict"]), (Some(0), &"pass".into()), "{block} {error}");
    }
}

#[test]
fn a_fault_of_a_faster_decoder_and_a_wrong_latency_are_found() {
    let folder = decoder();
    for clocks in [-3, -1, 0] {
        let (status, block, _) = verify(folder.path(), "tdc_decoder", &all(clocks), &SHORT);
        assert_eq!((status, &block["verdict"]), (Some(1), &"differs".into()), "{clocks}");
    }
    let path = folder.path().join("tdc_decoder.v");
    let text = fs::read_to_string(&path).unwrap();
    let faulty = text.replace("            n_valid <= 1'b0;\n", "");
    assert_ne!(text, faulty);
    fs::write(&path, faulty).unwrap();
    let args = [&SHORT[..], &["-o", "out"]].concat();
    let (status, block, _) = verify(folder.path(), "tdc_decoder", &all(-2), &args);
    assert_eq!((status, &block["verdict"]), (Some(1), &"differs".into()), "{block}");
    assert!(folder.path().join("out/tdc_decoder.vcd").exists());
}

#[test]
fn a_latency_that_no_design_can_have_is_refused_by_name() {
    let folder = decoder();
    let (status, _, error) = verify(folder.path(), "tdc_decoder", &all(-7), &[]);
    let expected = "map.toml: block.tdc_decoder.latency.tdc_code = -7: expected at least -6: tdc_decoder \
                    has tdc_code 6 clocks after the input that it depends on";
    assert!(status == Some(2) && error.contains(expected), "{error}");
    let folder = counter("", "");
    for (map, expected) in [
        ("latency = { coarse = -2 }", "latency.coarse = -2: expected at least -1"),
        ("latency = { coarse = 490 }", "leave some of 500 clock cycles to compare"),
        ("latency = { coarse = 10001 }", "map.toml:2:"),
        ("settle = 500", "leave some of 500 clock cycles to compare"),
    ] {
        let args = ["--cycles", "500"];
        let (status, _, error) = verify(folder.path(), "coarse_counter", map, &args);
        assert!(status == Some(2) && error.contains(expected), "{map}: {error}");
    }
}

#[test]
fn an_estimator_that_is_faster_is_not_started_while_ours_is_busy() {
    let folder = common::empty();
    for entry in fs::read_dir(OWN).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|end| end == "v") {
            fs::copy(&path, folder.path().join(path.file_name().unwrap())).unwrap();
        }
    }
    let path = folder.path().join("estimator_ctrl.v");
    let text = fs::read_to_string(&path).unwrap();
    let early = text.replace("if (step == Add) begin", "if (step == Add - 1'b1) begin");
    assert_ne!(early, text);
    fs::write(&path, early).unwrap();
    let map = "latency = { algo_done = -1 }";
    let args = ["--cycles", "6000"];
    let (status, block, error) = verify(folder.path(), "depth_estimator", map, &args);
    assert_eq!((status, &block["verdict"]), (Some(0), &"pass".into()), "{block} {error}");
    let (status, ..) = verify(folder.path(), "depth_estimator", "", &args);
    assert_eq!(status, Some(1));
}
