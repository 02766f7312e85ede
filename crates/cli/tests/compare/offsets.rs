//! Tests of the offsets at which samples are found: at every place, at both ends, before and after a time.

use std::fs;

use crate::common;

use super::align::{CLOCK, args, capture, part, sample, waveform, windows, word};
use super::{csv, different, refused, same, write};

#[test]
fn a_capture_is_found_wherever_it_lies() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    for begin in [0, 95, 96, 97, 98, 167, 168] {
        capture(folder, "ila.csv", 3, begin..begin + 32);
        let json = same(folder, &args(&[]));
        assert_eq!(json["offset"], -(begin as i64));
    }
    for begin in [170, 199] {
        capture(folder, "ila.csv", 3, begin..begin + 32);
        let error = refused(folder, &args(&[]));
        assert!(error.contains("fits nowhere") || error.contains("ambiguous"), "{error}");
    }
}

#[test]
fn waveforms_may_hang_over_each_other() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    write(folder, "late.vcd", &part(30..230));
    for align in ["correlation", "start"] {
        let how = [&CLOCK[..], &["--align", align, "--until", "2us"]].concat();
        let json = same(folder, &[&["wave.vcd", "late.vcd"], &how[..]].concat());
        assert_eq!((&json["offset"], &json["compared"]), (&(-30).into(), &170.into()));
        let json = same(folder, &[&["late.vcd", "wave.vcd"], &how[..]].concat());
        assert_eq!((&json["offset"], &json["compared"]), (&30.into(), &170.into()));
    }
    let how = [&CLOCK[..], &["--align", "correlation"]].concat();
    let json = same(folder, &[&["wave.vcd", "late.vcd"], &how[..]].concat());
    let text = json["alignment"].as_str().unwrap();
    assert!(text.contains("(0 of 1700 bits differ)"), "{text}");
}

#[test]
fn where_a_third_of_the_bits_differ_nothing_fits() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    let n = |step: u64| step.checked_sub(1).map_or(0, word) ^ 7;
    let rows: Vec<_> =
        (0..200).map(|step| format!("{:02x},{}", n(step), u8::from(step == 61))).collect();
    write(folder, "ila.csv", &csv("n[7:0],go", "HEX,HEX", 11, &rows));
    let error = refused(folder, &args(&[]));
    assert!(error.contains("best offset is 0 (600 of 1800 bits differ)"), "{error}");
}

#[test]
fn an_unknown_bit_half_agrees() {
    let folder = common::empty();
    let folder = folder.path();
    let text = part(0..200).replace("0c\n", "xc\n").replace("1c\n", "xc\n");
    write(folder, "wave.vcd", &text);
    capture(folder, "ila.csv", 11, 50..82);
    let json = same(folder, &args(&["--x", "any"]));
    let text = json["alignment"].as_str().unwrap();
    assert!(text.contains("offset -50 (16 of 288 bits differ)"), "{text}");
}

#[test]
fn samples_before_the_time_asked_for_are_not_looked_at() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    capture(folder, "ila.csv", 11, 50..82);
    let error = refused(folder, &args(&["--after", "700ns"]));
    assert!(error.contains("fits nowhere") || error.contains("ambiguous"), "{error}");
    capture(folder, "ila.csv", 11, 100..132);
    assert_eq!(same(folder, &args(&["--after", "700ns"]))["offset"], -100);
    // A sample just at that time is.
    capture(folder, "ila.csv", 0, 61..93);
    same(folder, &args(&["--trigger", "go", "--after", "615ns"]));
    let late = ["--trigger", "go", "--after", "625ns"];
    assert!(refused(folder, &args(&late)).contains("the trigger never comes"));
    // So are those that registers delay into it.
    write(folder, "map.toml", "input_stages = 1\n");
    same(folder, &args(&[&late[..], &["--map", "map.toml"]].concat()));
    same(folder, &args(&["--align", "edge go", "--after", "620ns"]));
}

#[test]
fn windows_are_found_in_the_order_of_time() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    write(folder, "ila.csv", &windows(&[(70..102, 3), (20..52, 3)]));
    let error = refused(folder, &args(&["--align", "windows"]));
    assert!(error.contains("window 1"), "{error}");
}

#[test]
fn a_clock_that_comes_to_be_known_does_not_rise() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    let text = fs::read_to_string(folder.join("wave.vcd")).unwrap().replacen("0a", "xa", 1);
    write(folder, "wave.vcd", &text);
    let json = same(folder, &[&["wave.vcd", "wave.vcd"], &CLOCK[..]].concat());
    assert_eq!(json["compared"], 199);
}

#[test]
fn the_command_line_s_clock_goes_before_the_map_s() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    write(folder, "map.toml", "clock = \"top.go\"\n");
    let map = ["wave.vcd", "wave.vcd", "--map", "map.toml"];
    assert_eq!(same(folder, &map)["compared"], 1);
    assert_eq!(same(folder, &[&map[..], &CLOCK].concat())["compared"], 200);
}

#[test]
fn samples_from_a_time_on_are_not_compared_whichever_side_has_times() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    let until = |files: [&str; 2], time| {
        let how = ["--until", time, "--align", "offset 0"];
        same(folder, &[&files[..], &CLOCK, &how].concat())["compared"].clone()
    };
    assert_eq!(until(["wave.vcd", "wave.vcd"], "105ns"), 10);
    assert_eq!(until(["wave.vcd", "wave.vcd"], "106ns"), 11);
    capture(folder, "ila.csv", 3, 0..32);
    assert_eq!(until(["wave.vcd", "ila.csv"], "105ns"), 10);
    assert_eq!(until(["ila.csv", "wave.vcd"], "105ns"), 10);
}

#[test]
fn differing_samples_have_their_times_in_the_waveform_of_both_sides() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    let mut rows: Vec<_> = (0..32).map(sample).collect();
    rows[10] = rows[10].replace(",0", ",1");
    write(folder, "ila.csv", &csv("n[7:0],go", "HEX,HEX", 3, &rows));
    let how = ["--align", "offset 0", "--waves", "both.vcd"];
    let json = different(folder, &args(&how));
    assert_eq!(json["first"]["first"]["at"].to_string(), "[105000.0,10.0]");
    let text = fs::read_to_string(folder.join("both.vcd")).unwrap();
    let (_, from) = text.split_once("#105000\n").unwrap();
    assert!(from.split_once("#115000\n").unwrap().0.contains("1'"), "{from}");
}
