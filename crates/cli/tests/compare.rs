//! `tofsim compare`, as its users run it.

mod align;
mod beats;
mod captures;
mod cases;
mod damage;
mod formats;
mod how;
mod odd;
mod offsets;
mod simulated;
mod times;
mod types;
mod verilog;
mod waveforms;
mod which;
mod windows;
mod words;

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common;

/// Status of a comparison and its JSON object.
fn compare(folder: &Path, args: &[&str]) -> (i32, Value) {
    let output = common::output(folder, &[&["compare", "--json"], args].concat());
    let status = output.status.code().unwrap();
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(status < 2, "{args:?}: {error}");
    let json = serde_json::from_slice(&output.stdout).unwrap();
    (status, json)
}

/// Asserts that two sides are equal; returns the JSON object.
#[track_caller]
fn same(folder: &Path, args: &[&str]) -> Value {
    let (status, json) = compare(folder, args);
    assert_eq!(status, 0, "{args:?}: {json:#}");
    assert_eq!(json["same"], true);
    assert!(json["compared"].as_u64().unwrap() > 0, "{json:#}");
    json
}

/// Asserts that two sides differ; returns the JSON object.
#[track_caller]
fn different(folder: &Path, args: &[&str]) -> Value {
    let (status, json) = compare(folder, args);
    assert_eq!(status, 1, "{args:?}: {json:#}");
    assert_eq!(json["same"], false);
    json
}

/// Why two sides cannot be compared.
#[track_caller]
fn refused(folder: &Path, args: &[&str]) -> String {
    common::refused(folder, &[&["compare"], args].concat())
}

fn write(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).unwrap();
}

/// Names of the signals that differ, the first first.
fn differing(json: &Value) -> Vec<String> {
    let signals = json["signals"].as_array().unwrap().iter();
    signals
        .filter(|signal| signal["differing"].as_u64().unwrap() > 0)
        .map(|signal| signal["name"].as_str().unwrap().to_owned())
        .collect()
}

/// Kinds of the findings.
fn findings(json: &Value) -> Vec<String> {
    let findings = json["findings"].as_array().unwrap().iter();
    findings.map(|finding| finding["kind"].as_str().unwrap().to_owned()).collect()
}

/// A VCD with the variables of `header`, `width name` each with the identifiers a, b, c ...
fn vcd(timescale: &str, scope: &str, variables: &[(u32, &str)], body: &str) -> String {
    let mut text = format!("$timescale {timescale} $end\n$scope module {scope} $end\n");
    for ((width, name), id) in variables.iter().zip('a'..) {
        text += &format!("$var wire {width} {id} {name} $end\n");
    }
    text + "$upscope $end\n$enddefinitions $end\n" + body
}

/// A capture with a radix row, from heads, radices and rows without their numbers; `trigger` is a row.
fn csv(heads: &str, radices: &str, trigger: usize, rows: &[String]) -> String {
    let mut text = format!(
        "Sample in Buffer,Sample in Window,TRIGGER,{heads}\n\
         Radix - UNSIGNED,UNSIGNED,UNSIGNED,{radices}\n"
    );
    for (k, row) in rows.iter().enumerate() {
        text += &format!("{k},{k},{},{row}\n", u8::from(k == trigger));
    }
    text
}
