//! Tests that the time for waveforms with many signals is proportional to their number.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use tofsim_captures::compare::{Options, compare};
use tofsim_captures::source::Source;

/// Number of signals per file; quadratic algorithms would take minutes.
const SIGNALS: usize = 100_000;

/// Writes a VCD of bits below `top`, with names given by `name`; all have the value `last` in the end.
fn wave(folder: &Path, top: &str, name: impl Fn(usize) -> String, last: u8) -> PathBuf {
    let path = folder.join(format!("{top}_{last}.vcd"));
    let mut text = format!("$timescale 1ns $end\n$scope module {top} $end\n");
    for k in 0..SIGNALS {
        writeln!(text, "$var wire 1 s{k} {} $end", name(k)).unwrap();
    }
    text += "$upscope $end\n$enddefinitions $end\n";
    for (time, value) in [(0, 0), (10, 1), (20, last)] {
        writeln!(text, "#{time}").unwrap();
        (0..SIGNALS).for_each(|k| writeln!(text, "{value}s{k}").unwrap());
    }
    fs::write(&path, text).unwrap();
    path
}

/// Compares two files with a time limit, and returns the number of pairs and of those that differ.
fn compared(a: &Path, b: &Path) -> (usize, usize) {
    let begun = Instant::now();
    let [a, b] = [a, b].map(|path| Source::file(path, None).unwrap());
    let result = compare(&a, &b, &Options::default()).unwrap();
    assert!(begun.elapsed() < Duration::from_secs(20), "{:?}", begun.elapsed());
    (result.pairs.len(), result.differing().count())
}

#[test]
fn many_names_are_matched_and_compared_in_time() {
    let folder = tempfile::tempdir().unwrap();
    let flat = |k: usize| format!("s_{k}");
    let [same, other] = [0, 1].map(|last| wave(folder.path(), "flat", flat, last));
    assert_eq!(compared(&same, &same), (SIGNALS, 0));
    assert_eq!(compared(&same, &other), (SIGNALS, SIGNALS));
}

#[test]
fn many_instances_of_one_name_are_matched_in_time_wherever_they_hang() {
    let folder = tempfile::tempdir().unwrap();
    let cell = |k: usize| format!("u_{k}.q");
    let [a, b] = ["top", "bench"].map(|top| wave(folder.path(), top, cell, 0));
    assert_eq!(compared(&a, &b), (SIGNALS, 0));
}
