//! `tofsim wave`, as its users run it. What it writes is read by other tools, and what it reads is of theirs.

mod cells;
mod convert;
mod cut;
mod described;
mod names;
mod other_tools;
mod refused;
mod stats;

use std::path::Path;

use crate::common::{output, stdout};

use cells::{Cells, cells, read};

/// Converts a waveform of `folder`.
#[track_caller]
fn convert(folder: &Path, from: &str, to: &str) {
    assert_eq!(stdout(folder, &["wave", "convert", from, "-o", to]), "");
}

/// Runs a program of another tool, and returns its output.
#[track_caller]
fn tool(folder: &Path, words: &[&str]) -> String {
    let output =
        std::process::Command::new(words[0]).current_dir(folder).args(&words[1..]).output();
    let output =
        output.unwrap_or_else(|error| panic!("{}: {error}: see CONTRIBUTING.md", words[0]));
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{words:?}: {error}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// What GTKWave's tool prints of an FST file.
#[track_caller]
fn of_fst(folder: &Path, name: &str) -> Cells {
    cells(&tool(folder, &["fst2vcd", name]))
}

/// The cells of a VCD file after GTKWave's tools have read it.
#[track_caller]
fn through_gtkwave(folder: &Path, name: &str) -> Cells {
    let fst = format!("{name}.gtkwave.fst");
    tool(folder, &["vcd2fst", name, &fst]);
    of_fst(folder, &fst)
}

/// Asserts that a command is refused, with what it prints, and that it leaves no file behind.
#[track_caller]
fn refused(folder: &Path, args: &[&str]) -> String {
    let files = || std::fs::read_dir(folder).unwrap().count();
    let before = files();
    let error = crate::common::refused(folder, &[&["wave"], args].concat());
    assert_eq!(files(), before, "{args:?} leaves files behind");
    error
}

/// Asserts that `tofsim compare` finds no difference, and compares as many signals.
#[track_caller]
fn same(folder: &Path, a: &str, b: &str, signals: usize) {
    let output = output(folder, &["wave", "diff", a, b, "--all", "--json"]);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect(&error);
    assert_eq!(output.status.code(), Some(0), "{json:#}");
    assert_eq!(json["signals"].as_array().unwrap().len(), signals, "{json:#}");
}
