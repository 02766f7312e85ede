//! A scenario that is simulated as far as a capture goes.

use std::path::Path;

use crate::common;

use super::{different, refused, same, write};

const FRAMES: [&str; 4] = ["--scenario", "estimator_validation", "frames.csv", "--map"];

/// Samples of several frames of the estimator alone, which take 524 cycles each.
fn capture(folder: &Path, options: &[&str]) {
    let args = ["ila", "capture", "--probes", "fig_6_21", "-o", ".", "--format", "csv"];
    common::stdout(folder, &[&args, options].concat());
    std::fs::rename(folder.join("fig_6_21.csv"), folder.join("frames.csv")).unwrap();
}

#[test]
fn it_goes_on_past_the_first_frame_unless_it_is_told_not_to() {
    let folder = common::empty();
    let folder = folder.path();
    capture(folder, &["--depth", "8192", "--frames", "20"]);
    let args = [&FRAMES[..], &["fig_6_21"]].concat();
    assert_eq!(same(folder, &args)["compared"], 8192);
    let json = different(folder, &[&args[..], &["--frames", "2"]].concat());
    assert!(
        json["differences"][0].as_str().unwrap().contains("ends after 807 samples"),
        "{json:#}"
    );
}

#[test]
fn what_is_searched_for_begins_in_its_first_frame() {
    let folder = common::empty();
    let folder = folder.path();
    capture(folder, &["--frames", "3", "--arm-at-us", "1"]);
    // It begins in the first frame and ends in the third.
    let args = [&FRAMES[..3], &["--clock", "clk_sys", "--align", "correlation"]].concat();
    write(
        folder,
        "map.toml",
        &std::fs::read_to_string(folder.join("fig_6_21.map.toml"))
            .unwrap()
            .replace("align = \"trigger\"\n", ""),
    );
    let args = [&args[..], &["--map", "map.toml"]].concat();
    assert_eq!(same(folder, &args)["compared"], 1024);
    let error = refused(folder, &[&args[..], &["--frames", "1"]].concat());
    assert!(error.contains("one side is too short"), "{error}");
}

#[test]
fn a_window_that_would_begin_before_power_up_is_said() {
    let folder = common::empty();
    let folder = folder.path();
    capture(folder, &["--frames", "4", "--position", "512", "--arm-at-us", "3.5"]);
    let late = std::fs::read_to_string(folder.join("fig_6_21.map.toml")).unwrap();
    write(folder, "map.toml", &late.replace("after_us = 3.5\n", ""));
    let run = [&FRAMES[..], &["map.toml", "--trigger"]].concat();
    let begins = "FORWARD1_EN rising && ALGO_DONE == 0";
    // What stood before the trigger is another frame's end.
    let json = compare_notes(folder, &[&run[..], &[begins]].concat());
    let too_early = "the trigger at sample 261 (3096 ns) does not count, because the capture has 512 \
        samples before its trigger, and there are 261";
    assert!(json.iter().any(|note| note.contains(too_early)), "{json:?}");
    let error = refused(folder, &[&run[..], &["clear_addr == 20", "--frames", "1"]].concat());
    assert!(error.contains("the trigger never comes after 0 us (it ends at "), "{error}");
    assert!(
        error.contains("the window would begin too early: the trigger at sample 22"),
        "{error}"
    );
}

/// The notes of a comparison.
fn compare_notes(folder: &Path, args: &[&str]) -> Vec<String> {
    let (_, json) = super::compare(folder, args);
    let notes = json["notes"].as_array().unwrap().iter();
    notes.map(|note| note["text"].as_str().unwrap().to_owned()).collect()
}
