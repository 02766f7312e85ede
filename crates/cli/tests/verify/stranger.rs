//! A tree that somebody else might have: sub-folders, a package behind its users, an include folder, a
//! bench that no simulator here takes, constants in place of parameters, nothing with a value at power-up,
//! and VHDL for one block. A map of thirteen lines says how it differs.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common;

use super::THEIRS;

fn verify(tree: &Path, args: &[&str]) -> (Option<i32>, Value) {
    let all = ["verify", "--rtl", "rtl", "-I", "include", "--map", "map.toml", "--json"];
    let output = common::output(tree, &[&all[..], args].concat());
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    let report = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{error}"));
    (output.status.code(), report)
}

/// The tree, a text in one file replaced.
fn tree(file: &str, old: &str, new: &str) -> tempfile::TempDir {
    fn copy(from: &Path, to: &Path) {
        fs::create_dir_all(to).unwrap();
        for entry in fs::read_dir(from).unwrap() {
            let (path, to) = (entry.as_ref().unwrap().path(), to.join(entry.unwrap().file_name()));
            if path.is_dir() { copy(&path, &to) } else { _ = fs::copy(&path, &to).unwrap() }
        }
    }
    let folder = common::empty();
    copy(&Path::new(THEIRS).join("stranger"), folder.path());
    let path = folder.path().join(file);
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(old), "{file} has no {old}");
    fs::write(&path, text.replacen(old, new, 1)).unwrap();
    folder
}

/// The blocks that pass, of which there is each of the tree's.
fn passed(report: &Value) -> Vec<&Value> {
    let blocks = report["blocks"].as_array().unwrap().iter();
    let passed: Vec<_> = blocks.filter(|block| block["verdict"] == "pass").collect();
    let names: Vec<_> = passed.iter().map(|block| block["block"].as_str().unwrap()).collect();
    assert_eq!(names, ["coarse_counter", "frame_ctrl", "histogram_builder"], "{report}");
    passed
}

#[test]
fn a_stranger_s_tree_passes_with_a_short_map() {
    let tree = tree("map.toml", "", "");
    assert!(fs::read_to_string(tree.path().join("map.toml")).unwrap().lines().count() < 15);
    let (status, report) = verify(tree.path(), &["--cycles", "5000"]);
    assert_eq!((status, passed(&report).len()), (Some(0), 3));
}

#[test]
#[ignore = "long: ./check --full"]
fn it_passes_in_verilator_with_all_vectors() {
    let tree = tree("map.toml", "", "");
    let (status, report) = verify(tree.path(), &["--simulator", "verilator"]);
    assert_eq!(status, Some(0), "{report}");
    for block in passed(&report) {
        assert_eq!(block["goals"]["met"], block["goals"]["of"], "{block}");
    }
}

#[test]
fn a_fault_in_each_of_its_modules_is_found() {
    for (file, old, new, block) in [
        ("include/widths.svh", "3'd7", "3'd6", "coarse_counter"),
        ("rtl/zz_pkg.sv", "9'd300", "9'd299", "frame_ctrl"),
        ("rtl/counting/histogram.vhd", "+ 1;", "+ 2;", "histogram_builder"),
    ] {
        let tree = tree(file, old, new);
        let block = format!("{block}.default");
        let (status, report) = verify(tree.path(), &["--block", &block, "--cycles", "3000"]);
        assert_eq!(status, Some(1), "{report}");
        assert_eq!(report["blocks"][0]["verdict"], "differs");
    }
}

#[test]
fn what_its_map_and_options_are_for_is_said_without_them() {
    let tree = tree("map.toml", "", "");
    let few = ["verify", "--rtl", "rtl", "--cycles", "100"];
    let refused = |args: &[&str]| common::refused(tree.path(), &[&few, args].concat());
    let error = refused(&["--map", "map.toml"]);
    assert!(error.contains("widths.svh") && error.contains("-I DIR"), "{error}");
    let error = refused(&["-I", "include"]);
    assert!(error.contains("a map with their names"), "{error}");
    let map = fs::read_to_string(tree.path().join("map.toml")).unwrap();
    let with_parameters = map.replace("parameters = false, ", "");
    fs::write(tree.path().join("map.toml"), with_parameters).unwrap();
    let error = refused(&["-I", "include", "--map", "map.toml"]);
    assert!(error.contains("[block.frame_ctrl.parameters] ShotsPerFrame = \"\""), "{error}");
}
