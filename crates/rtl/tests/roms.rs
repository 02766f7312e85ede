//! The memories in `rtl_ref/` are those of the built-in network, chain and stimuli.
//!
//! `UPDATE_ROMS=1 cargo test -p tofsim-rtl --test rtl roms` writes them anew.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use tofsim::network::mem::Mem;
use tofsim_rtl::golden::parameters;

use crate::common;

/// Which memories come from another scenario than the board on the desk: the stand-ins' stimuli.
const STIMULI: [(&str, &str); 2] =
    [("codes.mem", "histogram_validation"), ("histogram.mem", "estimator_validation")];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../rtl_ref")
}

/// Returns the expected memory contents.
fn expected() -> BTreeMap<String, String> {
    let of = |scenario, set: &[&str]| {
        let parameters = parameters::whole::tof_top(&common::setup(scenario, set));
        let text = |memory: &Mem| (memory.name.to_string(), memory.text.clone());
        parameters::memories(&parameters).map(text).collect::<BTreeMap<_, _>>()
    };
    let mut expected = of("kc705", &[]);
    expected.extend(of("kc705", &["estimator.kind=likelihood"]));
    for (name, scenario) in STIMULI {
        expected.insert(name.to_owned(), of(scenario, &[]).remove(name).unwrap());
    }
    expected
}

/// The value of a parameter in the text of a module.
fn default<'a>(text: &'a str, parameter: &str) -> &'a str {
    let (_, rest) = text.split_once(&format!(" {parameter} = ")).unwrap();
    rest.split([',', '\n', ' ']).next().unwrap()
}

#[test]
fn the_memories_of_the_reference_rtl_are_current() {
    let expected = expected();
    if std::env::var_os("UPDATE_ROMS").is_some() {
        for (name, text) in &expected {
            fs::write(folder().join(name), text).unwrap();
        }
    }
    let mut there = common::files(&folder());
    there.retain(|name| name.ends_with(".mem"));
    assert!(there.iter().eq(expected.keys()), "{there:?} are not the memories that we make");
    for (name, text) in &expected {
        let same = fs::read_to_string(folder().join(name)).unwrap() == *text;
        let how = "UPDATE_ROMS=1 cargo test -p tofsim-rtl --test rtl roms";
        assert!(same, "rtl_ref/{name} is out of date: {how}");
    }
}

#[test]
fn the_number_of_codes_is_the_length_of_their_memory() {
    let codes = fs::read_to_string(folder().join("codes.mem")).unwrap().lines().count();
    for module in ["tof_top.v", "code_preload.v"] {
        let text = fs::read_to_string(folder().join(module)).unwrap();
        assert_eq!(default(&text, "Codes"), codes.to_string(), "Codes in rtl_ref/{module}");
    }
}

#[test]
fn every_memory_that_a_module_names_is_there() {
    let names = expected();
    for module in common::files(&folder()).iter().filter(|name| name.ends_with(".v")) {
        let text = fs::read_to_string(folder().join(module)).unwrap();
        for name in text.split('"').filter(|word| word.ends_with(".mem")) {
            let known = name.strip_prefix("rtl_ref/").is_some_and(|name| names.contains_key(name));
            assert!(known, "rtl_ref/{module} names {name}");
        }
    }
}
