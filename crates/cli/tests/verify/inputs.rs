//! Inputs of a design that ours lacks: left open with a note, or tied by a map.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common;

use super::counter;

/// Our counter with two more inputs, without which it does not count.
fn enabled() -> tempfile::TempDir {
    let folder = counter(
        "input wire rst,",
        "input wire [1:0] enable, input wire m_axis_tready, input wire rst,",
    );
    let path = folder.path().join("coarse_counter.v");
    let text = fs::read_to_string(&path).unwrap();
    let new = text.replace("coarse + 1'b1", "coarse + (enable == 2'd2 && m_axis_tready)");
    assert_ne!(text, new);
    fs::write(path, new).unwrap();
    folder
}

fn verify(folder: &Path, args: &[&str]) -> (Option<i32>, Value, String) {
    let all = ["verify", "--rtl", ".", "--block", "coarse_counter", "--cycles", "1000", "--json"];
    let output = common::output(folder, &[&all[..], args].concat());
    let report = serde_json::from_slice(&output.stdout).unwrap_or_default();
    (output.status.code(), report, String::from_utf8(output.stderr).unwrap())
}

fn with_map(folder: &Path, tie: &str, args: &[&str]) -> (Option<i32>, Value, String) {
    let map = format!("[block.coarse_counter]\ntie = {{ {tie} }}\n");
    fs::write(folder.join("map.toml"), map).unwrap();
    verify(folder, &[&["--map", "map.toml"], args].concat())
}

#[test]
fn an_input_that_nothing_drives_is_noted_with_the_entry_that_ties_it() {
    let folder = enabled();
    let (status, report, error) = verify(folder.path(), &[]);
    assert_eq!((status, &report["blocks"][0]["verdict"]), (Some(1), &"differs".into()));
    for input in ["enable", "m_axis_tready"] {
        let note =
            format!("note: block.coarse_counter.tie.{input} = open: nothing drives this input");
        assert!(error.contains(&note), "{error}");
    }
    assert_eq!(report["notes"][0]["code"], "open-input");
    let (status, report, error) = with_map(folder.path(), "m_axis_tready = 1", &["--strict"]);
    assert_eq!((status, report["notes"].as_array().unwrap().len()), (Some(2), 1), "{error}");
}

#[test]
fn an_input_that_a_map_ties_is_driven_in_both_simulators() {
    let folder = enabled();
    for simulator in ["icarus", "verilator"] {
        let args = ["--simulator", simulator, "--strict"];
        let (status, report, error) =
            with_map(folder.path(), "enable = 0b10, m_axis_tready = 1", &args);
        assert_eq!((status, &report["passed"]), (Some(0), &true.into()), "{error}");
        assert_eq!(report["notes"], Value::Null);
    }
    let vectors = ["vectors", "coarse_counter", "--rtl", ".", "--map", "map.toml", "-o", "out"];
    assert_eq!(common::output(folder.path(), &vectors).status.code(), Some(0));
    let adapter = folder.path().join("out/coarse_counter/coarse_counter_adapter.v");
    let adapter = fs::read_to_string(adapter).unwrap();
    assert!(
        adapter.contains(".enable(2'd2)") && adapter.contains(".m_axis_tready(1'd1)"),
        "{adapter}"
    );
    let error = common::output(folder.path(), &[&vectors[..4], &["-o", "open"]].concat()).stderr;
    assert!(String::from_utf8(error).unwrap().contains("tie.enable = open"));
}

#[test]
fn what_cannot_be_tied_is_refused_with_its_entry() {
    let folder = enabled();
    for (tie, expected) in [
        (
            "enable = 4",
            "map.toml: block.coarse_counter.tie.enable = 4: expected 0 to 3: enable has 2 bits",
        ),
        ("enabl = 1", "has no such input (`enable`?)"),
        ("window = 1", "expected an input; window is an output"),
        ("start = 1", "the bench drives start"),
        ("enable = -1", "map.toml:2:"),
    ] {
        let (status, _, error) = with_map(folder.path(), tie, &[]);
        assert!(status == Some(2) && error.contains(expected), "{tie}: {error}");
    }
}

#[test]
fn an_input_of_an_entity_is_tied_whatever_its_letters() {
    let folder = common::empty();
    let ours = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vhdl/coarse_counter.vhd");
    let text = fs::read_to_string(ours).unwrap();
    let new = text.replacen("rst", "Enable : in std_logic;\n    rst", 1);
    let new = new.replacen("rising_edge(clk_sys)", "rising_edge(clk_sys) and Enable = '1'", 1);
    fs::write(folder.path().join("a.vhd"), &new).unwrap();
    let (status, _, error) = verify(folder.path(), &[]);
    assert!(status == Some(1) && error.contains("tie.Enable = open"), "{error}");
    let (status, report, error) = with_map(folder.path(), "Enable = 1", &[]);
    assert_eq!((status, &report["passed"]), (Some(0), &true.into()), "{error}");
}
