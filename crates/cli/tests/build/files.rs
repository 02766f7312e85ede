//! Tests of the folder's contents, and of refused input.

use std::fs;

use crate::common::{output, refused, tofsim};

use super::{ALONE, SMALL, build, journal, small};

#[test]
fn every_step_leaves_its_files_and_a_missing_tool_is_named() {
    let folder = small();
    let path = folder.path();
    let nothing = path.join("nothing");
    fs::create_dir(&nothing).unwrap();
    let args = ["build", "small.toml", "-o", "out", "--quick"];
    let done = tofsim(path, &args).env("PATH", &nothing).output().unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{said}");
    for line in [
        "cycles: not done: iverilog is not on PATH; install it: apt-get install iverilog",
        "cost: not done: yosys is not on PATH; install it: apt-get install yosys",
    ] {
        assert!(said.contains(line), "{said}");
    }
    for name in [
        "small.toml",
        "chain.toml",
        "network.toml",
        "training/curve.svg",
        "rtl/instrument.v",
        "rtl/kc705_top.v",
        "rtl/tof_top.v",
        "rtl/w1.mem",
        "constraints.xdc",
        "vectors/tdc/tb_tdc.v",
        "frame/small.vcd",
        "frame/small.gtkw",
        "frame/small.sucl",
        "accuracy/evaluation.json",
        "report.html",
    ] {
        assert!(path.join("out").join(name).exists(), "{name}");
    }
    let page = fs::read_to_string(path.join("out/report.html")).unwrap();
    assert!(page.contains("This was not counted: Yosys was not there."));
    let (_, said) = build(path, &["--steps", ALONE]);
    assert!(!said.contains(" s)"), "all that could be done was done: {said}");
}

#[test]
#[ignore = "long: ./check --full"]
fn the_module_with_the_parameters_is_held_to_the_model() {
    let folder = small();
    let path = folder.path();
    let (status, said) = build(path, &["--steps", "network,verilog,verify"]);
    assert_eq!(status, 0, "{said}");
    let blocks = journal(path)["steps"]["verify"]["result"]["blocks"].clone();
    let whole = blocks.as_array().unwrap().last().unwrap().clone();
    assert_eq!(
        (whole["block"].as_str(), whole["verdict"].as_str()),
        (Some("instrument, a frame"), Some("pass"))
    );
    // A parameter or a ROM that is not the instrument's is found.
    let plant = |name: &str, from: &str, to: &str| {
        let file = path.join("out/rtl").join(name);
        let text = fs::read_to_string(&file).unwrap();
        assert!(text.contains(from), "{name}: {text}");
        fs::write(&file, text.replacen(from, to, 1)).unwrap();
        let map = "rtl/instrument.map.toml";
        let args =
            ["verify", "--rtl", "rtl", "--map", map, "--top", "--scenario", "small.toml", "--json"];
        let found = output(&path.join("out"), &args).status.code();
        fs::write(&file, text).unwrap();
        found
    };
    assert_eq!(plant("instrument.v", ".Digits(", ".Digits(1 + "), Some(1));
    assert_eq!(plant("instrument.v", ".DrainCycles(16)", ".DrainCycles(17)"), Some(1));
    // Of the output's bias, the first digit.
    let bias = fs::read_to_string(path.join("out/rtl/b2.mem")).unwrap();
    let other = if bias.starts_with('3') { "2" } else { "3" };
    assert_eq!(plant("b2.mem", &bias[..1], other), Some(1));
}

#[test]
fn what_cannot_be_built_is_refused_and_leaves_nothing() {
    let folder = small();
    let path = folder.path();
    let try_with = |from: &str, to: &str| {
        fs::write(path.join("small.toml"), SMALL.replace(from, to)).unwrap();
        let error = refused(path, &["build", "small.toml", "-o", "bad", "--quick"]);
        assert!(!path.join("bad").exists(), "{error}");
        error
    };
    for (from, to, expected) in [
        ("bins = 16", "bins = 17", "small.toml:5:8: tdc.bins = 17: expected a power of two"),
        ("neurons = 2", "neurons = 99", "training.neurons = 99: expected a whole number from 1"),
        ("./small_chain.toml", "./none.toml", "none.toml: cannot read"),
        ("\"target.distance_m\" =", "\"target.distanse_m\" =", "distanse_m"),
        ("0.2..0.7:0.1", "0.7..0.2:0.1", "0.7..0.2:0.1: expected FROM below TO"),
        ("\"quick\"", "\"./none.toml\"", "none.toml: no such file; built-in recipes are"),
        ("neurons = 2", "formats = { w3 = \"16.23\" }", "w3: unknown key"),
        (
            "neurons = 2",
            "formats = { w1 = \"16\" }",
            "training.formats.w1 = 16: expected WIDTH.FRACTION",
        ),
    ] {
        let error = try_with(from, to);
        assert!(error.contains(expected), "{expected}: {error}");
    }
    fs::write(path.join("small.toml"), SMALL).unwrap();
    let here = refused(path, &["build", "small.toml", "-o", ".", "--quick"]);
    assert!(here.contains("expected another folder than the file's own"), "{here}");
    let early = refused(path, &["build", "small.toml", "-o", "bad", "--steps", "frame"]);
    assert!(early.contains("--steps: frame: frame needs network, which is not there"), "{early}");
    let unknown = refused(path, &["build", "small.toml", "-o", "bad", "--steps", "paint"]);
    assert!(unknown.contains("paint"), "{unknown}");
}
