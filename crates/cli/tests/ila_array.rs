//! Captures of the firmware that scans an array.

use std::fs;
use std::path::Path;

use crate::common::{self, empty, files, json, refused, stdout};
use crate::waveform::Wave;

/// A small array of short frames.
const ARRAY: [&str; 7] =
    ["array", "-s", "array.rows=2", "-s", "array.columns=4", "-s", "firmware.shots_per_frame=200"];

/// Signals of the first column, of others, and of what they share.
const PROBES: [&str; 14] = [
    "frame_ctrl.row",
    "frame_ctrl.shots",
    "start",
    "tdc_valid",
    "tdc_code",
    "channel_1.code_valid",
    "channel_1.code",
    "channel_2.tdc.tdc_latch.hit",
    "channel_2.bank_0.counting",
    "channel_3.tdc_stop",
    "channel_3.code",
    "algo_done",
    "frame_ctrl.depth_column",
    "depth",
];

/// Writes a configuration with some keys and those probes, all in binary.
fn set_up(folder: &Path, head: &str) {
    let probe = |signal: &str| format!("[[probe]]\nsignal = \"{signal}\"\nradix = \"binary\"\n");
    let text = format!("scenario = \"array\"\n{head}\n{}", PROBES.map(probe).concat());
    fs::write(folder.join("own.toml"), text).unwrap();
}

fn capture<'a>(options: &[&'a str]) -> Vec<&'a str> {
    [&["ila", "capture"], &ARRAY[..], &["--probes", "own.toml", "-o", "."], options].concat()
}

fn traced(folder: &Path, options: &[&str]) -> Wave {
    let waves = ["--waves", "vcd", "-q", "-o", "."];
    stdout(folder, &[&["image"], &ARRAY[..], &waves, options].concat());
    Wave::open(&folder.join("array.vcd"))
}

/// Returns the columns of the probes in a capture's CSV, the first one first.
fn columns(path: &Path) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().from_path(path).unwrap();
    let rows: Vec<_> = reader.records().skip(1).map(Result::unwrap).collect();
    let probe = |k: usize| rows.iter().map(|row| row[3 + k].to_owned()).collect();
    (0..PROBES.len()).map(probe).collect()
}

#[test]
fn each_sample_is_the_value_of_the_waveform_just_before_the_edge() {
    let folder = empty();
    let folder = folder.path();
    let wave = traced(folder, &["--window", "0us..80us"]);
    for (clock, period_ps, trigger, position) in [
        ("clk_sys", 8_000, "channel_3.code_valid rising", 16),
        ("clk_laser", 4_000, "channel_1.tdc_stop falling && frame_ctrl.row == 0", 512),
        // While the second row is acquired, the first one is estimated.
        ("clk_sys", 8_000, "algo_done == 1 && frame_ctrl.depth_column == 1", 300),
        ("100MHz + 250ps", 10_000, "channel_2.code_valid rising", 1),
    ] {
        set_up(folder, &format!("clock = \"{clock}\"\ntrigger = \"{trigger}\""));
        let before = position.to_string();
        let found = json(folder, &capture(&["--position", &before, "--json"]));
        let trigger_us = found["trigger_times_us"][0].as_f64().unwrap();
        let first_ps = (1e6 * trigger_us).round() as u64 - position * period_ps;
        let mut moving = 0;
        for (name, column) in PROBES.iter().zip(columns(&folder.join("own.csv"))) {
            assert_eq!(column.len(), 1024, "{name}");
            let changes = wave.changes(name);
            for (k, value) in column.iter().enumerate() {
                let edge_ps = first_ps + k as u64 * period_ps;
                let later = changes.partition_point(|(at, _)| *at < edge_ps);
                let (at, expected) = &changes[later - 1];
                assert_eq!(value, expected, "{name} at sample {k} of {clock}, changed at {at} ps");
            }
            moving += usize::from(column.iter().any(|value| *value != column[0]));
        }
        assert!(moving >= 3, "{moving} of the probes change in {trigger}");
    }
}

#[test]
fn a_trigger_is_a_condition_over_any_channel() {
    let folder = empty();
    let folder = folder.path();
    set_up(folder, "trigger = \"channel_1.code_valid rising\"");
    let options = ["--windows", "4", "--position", "2", "--json", "--format", "csv"];
    let found = json(folder, &capture(&options));
    let times = found["trigger_times_us"].as_array().unwrap();
    let column = &columns(&folder.join("own.csv"))[5];
    let triggers: Vec<_> = [2, 258, 514, 770].map(|at| &column[at - 1..=at]).to_vec();
    assert!(triggers.iter().all(|pair| pair == &["0", "1"]), "{triggers:?}");
    let rises = traced(folder, &["--window", "0us..45us"]).rises("channel_1.code_valid");
    // The edge after that which shows the hit.
    let first = (1e6 * times[0].as_f64().unwrap()) as u64;
    assert_eq!((times.len(), first), (4, rises[0] + 8_000));
    assert!(found["end_us"].as_f64().unwrap() < 45.0, "it ends with the buffer: {found}");
}

#[test]
fn captures_compare_with_waveforms_simulations_and_each_other() {
    let folder = empty();
    let folder = folder.path();
    set_up(folder, "trigger = \"channel_3.code_valid rising\"");
    stdout(folder, &capture(&["-q"]));
    traced(folder, &["--window", "0us..45us"]);
    let map = ["--map", "own.toml"];
    let simulated = [&["compare", "--scenario"], &ARRAY[..], &["own.ila"], &map].concat();
    for words in [
        &["compare", "array.vcd", "own.ila", "--map", "own.map.toml"][..],
        &["compare", "own.csv", "own.ila"],
        &simulated,
    ] {
        let text = stdout(folder, words);
        assert!(text.ends_with("same\n") && text.contains("14 signals"), "{words:?}: {text}");
    }
    let other = common::output(folder, &[&simulated[..], &["--seed", "9"]].concat());
    assert_eq!(other.status.code(), Some(1), "another seed has other codes");
}

#[test]
fn the_built_in_set_up_shows_codes_and_the_depth_of_a_pixel() {
    let folder = empty();
    // The first depth comes while the second row is acquired.
    let longer = ["-s", "firmware.shots_per_frame=1000"];
    let words = ["--probes", "array", "-o", ".", "--json"];
    let words = [&["ila", "capture"], &ARRAY[..], &longer, &words];
    let found = json(folder.path(), &words.concat());
    assert_eq!((&found["samples"], &found["full"]), (&1024.into(), &true.into()));
    let mut reader = csv::Reader::from_path(folder.path().join("array.csv")).unwrap();
    let heads = reader.headers().unwrap().clone();
    let rows: Vec<_> = reader.records().skip(1).map(Result::unwrap).collect();
    let value = |sample: usize, name: &str| {
        let is_it = |head: &str| head.split('[').next() == Some(name);
        rows[sample][heads.iter().position(is_it).expect(name)].to_owned()
    };
    let of_trigger = ["ALGO_DONE", "DEPTH_ROW", "DEPTH_COLUMN"].map(|name| value(512, name));
    assert_eq!(
        (of_trigger, value(512, "ROW")),
        (["1", "0", "0"].map(str::to_owned), "1".to_owned())
    );
    for valid in ["TDC_VALID", "CODE_VALID_1", "CODE_VALID_2", "CODE_VALID_3"] {
        let hits = (0..1024).filter(|&sample| value(sample, valid) == "1");
        assert!(hits.count() > 100, "{valid}");
    }
}

#[test]
fn what_an_array_has_not_is_named() {
    let folder = empty();
    let folder = folder.path();
    let own = |signal: &str, options: &[&str]| {
        fs::write(folder.join("own.toml"), format!("[[probe]]\nsignal = \"{signal}\"\n")).unwrap();
        refused(folder, &capture(options))
    };
    let beyond = own("channel_4.code", &[]);
    let place = "own.toml:2:10: probe.0.signal = \"channel_4.code\": no such signal: the array has 4 \
                 columns (array.columns); expected channel_1 to channel_3";
    assert!(beyond.contains(place), "{beyond}");
    for (signal, options, said) in [
        ("start", &["-s", "array.rows=41"][..], "array.rows = 41: expected at most 40"),
        ("start", &["-s", "pll.jitter_rms_ps=5"], "pll.jitter_rms_ps"),
        ("start", &["-s", "tdc.recalibrate_frames=3"], "expected 0 with an array"),
        (
            "start",
            &["--trigger", "channel_9.code == 1"],
            "--trigger:1:1: channel_9.code: no such signal: the array has 4",
        ),
        (
            "start",
            &["--trigger", "algo_done rising", "-s", "firmware.dsp_en=false"],
            "firmware.dsp_en = false: expected true: no row of the array ends",
        ),
        (
            "start",
            &["--trigger", "frame_ctrl.row == 2"],
            "--trigger: frame_ctrl.row == 2: never held before the run ended",
        ),
    ] {
        let error = own(signal, options);
        assert!(error.contains(said), "{options:?}: {error}");
    }
    assert_eq!(files(folder), ["own.toml"]);
    let single = refused(folder, &["ila", "capture", "kc705", "--probes", "array", "-o", "."]);
    assert!(single.contains("probe.1.signal = \"frame_ctrl.row\""), "{single}");
}

#[test]
fn what_takes_a_single_pixel_says_so() {
    let folder = empty();
    let folder = folder.path();
    let tcl = refused(folder, &["ila", "tcl", "--probes", "array"]);
    assert!(tcl.contains("scenario array: array.rows = 40: expected 1: the tops of the"), "{tcl}");
    set_up(folder, "");
    stdout(folder, &capture(&["-q"]));
    let replay = |more: &[&str]| {
        let words = ["ila", "replay", "own.ila", "-o", "again/run.toml"];
        refused(folder, &[&words[..], more].concat())
    };
    let channels = replay(&[]);
    let said = "own.ila: channel_1/code_valid: expected probes of a single pixel only";
    assert!(channels.contains(said), "{channels}");
    let array = replay(&["--scenario", "array"]);
    assert!(array.contains("array.rows = 40: expected 1 here"), "{array}");
}
