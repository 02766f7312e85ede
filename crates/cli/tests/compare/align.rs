//! Tests of the alignment of the samples of two sides.

use std::fs;
use std::ops::Range;
use std::path::Path;

use crate::common;

use super::{csv, different, differing, refused, same, vcd, write};

/// A waveform of a clock of 10 ns, rising at 5, 15, 25 ... ns, a word that never repeats within 200
/// steps, and a pulse at step 60; both change with the clock.
pub fn waveform(folder: &Path) {
    write(folder, "wave.vcd", &part(0..200));
}

/// Some steps of that waveform.
pub fn part(steps: Range<u64>) -> String {
    let before = steps.start.checked_sub(1).map_or(0, word);
    let mut body = format!("#{}\n0a\nb{before:b} b\n0c\n", 10 * steps.start);
    for step in steps {
        let (rise, fall) = (5 + 10 * step, 10 + 10 * step);
        body +=
            &format!("#{rise}\n1a\nb{:b} b\n{}c\n#{fall}\n0a\n", word(step), u8::from(step == 60));
    }
    vcd("1ns", "top", &[(1, "clk"), (8, "n"), (1, "go")], &body)
}

/// The word after step `step`.
pub fn word(step: u64) -> u64 {
    step * 167 % 251
}

/// Returns a logic analyser's sample at step `step`: the values before its edge.
pub fn sample(step: u64) -> String {
    let before = step.checked_sub(1);
    let (n, go) = (before.map_or(0, word), u8::from(before == Some(60)));
    format!("{n:02x},{go}")
}

pub fn capture(folder: &Path, name: &str, trigger: usize, steps: impl Iterator<Item = u64>) {
    let rows: Vec<_> = steps.map(sample).collect();
    write(folder, name, &csv("n[7:0],go", "HEX,HEX", trigger, &rows));
}

/// A capture of several windows, each with its steps and the place of its trigger.
pub fn windows(windows: &[(Range<u64>, usize)]) -> String {
    let mut text = String::from(
        "Sample in Buffer,Sample in Window,TRIGGER,n[7:0],go\nRadix - UNSIGNED,UNSIGNED,UNSIGNED,HEX,HEX\n",
    );
    let mut buffer = 0;
    for (steps, trigger) in windows {
        for (place, step) in steps.clone().enumerate() {
            text += &format!("{buffer},{place},{},{}\n", u8::from(place == *trigger), sample(step));
            buffer += 1;
        }
    }
    text
}

pub const CLOCK: [&str; 2] = ["--clock", "top.clk"];

pub fn args<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["wave.vcd", "ila.csv"], &CLOCK[..], more].concat()
}

#[test]
fn by_the_trigger_s_condition() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    capture(folder, "ila.csv", 11, 50..82);
    let json = same(folder, &args(&["--trigger", "go rising"]));
    assert_eq!(json["offset"], -50);
    let error = refused(folder, &args(&["--trigger", "go rising", "--after", "700ns"]));
    assert!(error.contains("the trigger never comes after 0.7 us"), "{error}");
    let error = refused(folder, &args(&["--align", "trigger"]));
    assert!(error.contains("expected a condition (--trigger"), "{error}");
    let error = refused(folder, &args(&["--trigger", "gone rising"]));
    assert!(error.contains("gone") && error.contains("no such signal"), "{error}");
}

#[test]
fn by_correlation_with_how_well_the_next_best_does() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    capture(folder, "ila.csv", 11, 50..82);
    let json = same(folder, &args(&[]));
    assert_eq!(json["offset"], -50);
    let text = json["alignment"].as_str().unwrap();
    assert!(text.contains("offset -50 (0 of 288 bits differ); next best "), "{text}");
    same(folder, &args(&["--align", "correlation n"]));
    capture(folder, "ila.csv", 11, 100..132);
    let error = refused(folder, &args(&["--align", "correlation go"]));
    assert!(error.contains("ambiguous"), "{error}");
}

#[test]
fn correlation_finds_a_capture_with_a_fault_in_it() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    let mut rows: Vec<_> = (50..114).map(sample).collect();
    rows[40] = "ff,0".into();
    write(folder, "ila.csv", &csv("n[7:0],go", "HEX,HEX", 11, &rows));
    let json = different(folder, &args(&[]));
    assert_eq!((&json["offset"], &json["first"]["differing"]), (&(-50).into(), &1.into()));
}

#[test]
fn what_fits_nowhere_is_refused() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    let rows: Vec<_> = (0..64u64).map(|k| format!("{:02x},1", k * k * 77 % 256)).collect();
    write(folder, "ila.csv", &csv("n[7:0],go", "HEX,HEX", 11, &rows));
    let error = refused(folder, &args(&[]));
    assert!(error.contains("fits nowhere") || error.contains("ambiguous"), "{error}");
}

#[test]
fn by_the_first_edge_of_a_signal_or_a_given_offset() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    capture(folder, "ila.csv", 11, 50..82);
    same(folder, &args(&["--align", "edge go"]));
    same(folder, &args(&["--align", "offset -50"]));
    // A value that comes to be known is no edge.
    let text = fs::read_to_string(folder.join("wave.vcd")).unwrap().replacen("0c", "xc", 1);
    write(folder, "unknown.vcd", &text);
    same(folder, &[&["unknown.vcd", "ila.csv"], &CLOCK[..], &["--align", "edge go"]].concat());
    let json = different(folder, &args(&["--align", "offset -49"]));
    assert_eq!(json["findings"][0]["kind"], "shifted window", "{json:#}");
    let error = refused(folder, &args(&["--align", "offset 8ns"]));
    assert!(error.contains("expected samples"), "{error}");
}

#[test]
fn each_window_alone() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    let text = windows(&[(20..52, 3), (70..102, 3), (140..172, 3)]);
    write(folder, "ila.csv", &text);
    let json = same(folder, &args(&["--align", "windows"]));
    assert_eq!(json["compared"], 96);
    let error = refused(folder, &args(&["--align", "correlation"]));
    assert!(error.contains("the time between the 3 windows is not known"), "{error}");
    let damaged = text.replace(&format!("80,16,0,{}", sample(156)), "80,16,0,00,0");
    write(folder, "ila.csv", &damaged);
    let json = different(folder, &args(&["--align", "windows"]));
    assert_eq!(json["first"]["first"]["window"], 2);
    let json = different(folder, &args(&[]));
    let told = json["alignment"].as_str().unwrap();
    assert!(told.starts_with("window 0: correlation: offset -20 (0 of 288 bits differ)"), "{told}");
}

#[test]
fn windows_of_which_every_sample_differs_are_found_too() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    let stuck = |text: String| {
        let line = |line: &str| match line.rsplit_once(',') {
            Some((rest, "0")) => format!("{rest},1\n"),
            _ => format!("{line}\n"),
        };
        text.lines().map(line).collect::<String>()
    };
    write(folder, "ila.csv", &stuck(windows(&[(20..52, 3), (70..102, 3), (140..172, 3)])));
    let json = different(folder, &args(&[]));
    assert_eq!((differing(&json), &json["compared"]), (vec!["top.go".to_owned()], &96.into()));
}

#[test]
fn windows_follow_each_other_and_many_are_told_by_the_first() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    write(folder, "ila.csv", &windows(&[(20..40, 3), (30..50, 3)]));
    let error = refused(folder, &args(&[]));
    assert!(error.contains("window 1 fits"), "{error}");
    let many: Vec<_> = (0..12).map(|k| (15 * k..15 * k + 12, 3)).collect();
    write(folder, "ila.csv", &windows(&many));
    let json = same(folder, &args(&[]));
    let lines: Vec<_> = json["alignment"].as_str().unwrap().lines().collect();
    assert_eq!((lines.len(), lines[7]), (8, "... and 5 more windows"));
}

#[test]
fn samples_that_a_condition_qualified() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    let even = |step: &u64| step.checked_sub(1).map_or(0, word).is_multiple_of(2);
    let kept: Vec<u64> = (0..200).filter(|step| even(step) || *step == 61).collect();
    let at = kept.iter().position(|&step| step == 61).unwrap();
    let kept = &kept[at - 5..at + 27];
    capture(folder, "ila.csv", 5, kept.iter().copied());
    let condition = ["--trigger", "go rising", "--qualified-by", "n[0] == 0"];
    same(folder, &args(&condition));
    same(folder, &args(&[&condition[..], &["--after", "100ns"]].concat()));
    different(folder, &args(&condition[..2]));
    let error = refused(folder, &args(&["--qualified-by", "n[0] == 0"]));
    assert!(error.contains("--align: expected trigger"), "{error}");
}

#[test]
fn samples_by_a_column_that_counts_the_clock() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    let steps: Vec<u64> = vec![50, 51, 55, 61, 62, 80, 99, 130, 131];
    let rows: Vec<_> =
        steps.iter().map(|&step| format!("{},{}", sample(step), (step + 150) % 256)).collect();
    write(folder, "ila.csv", &csv("n[7:0],go,cycle[7:0]", "HEX,HEX,UNSIGNED", 3, &rows));
    let counted = ["--time-from", "cycle", "--ignore", "cycle"];
    same(folder, &args(&[&counted[..], &["--trigger", "go rising"]].concat()));
    same(folder, &args(&[&counted[..], &["--align", "offset 50"]].concat()));
    different(folder, &args(&[&counted[..], &["--align", "offset 51"]].concat()));
    let error = refused(folder, &args(&["--time-from", "go", "--trigger", "go rising"]));
    assert!(error.contains("does not change at sample 1"), "{error}");
    // Samples before the waveform begins are left out.
    for (begin, compared) in [(51, 8), (52, 7)] {
        write(folder, "wave.vcd", &part(begin..200));
        let offset = format!("offset {}", 50 - begin as i64);
        let json = same(folder, &args(&[&counted[..], &["--align", &offset]].concat()));
        assert_eq!(json["compared"], compared);
    }
    let rows = ["00,0,c8", "00,0,XX"].map(str::to_owned);
    write(folder, "ila.csv", &csv("n[7:0],go,cycle[7:0]", "HEX,HEX,HEX", 0, &rows));
    let error = refused(folder, &args(&[&counted[..], &["--align", "offset 0"]].concat()));
    assert!(error.contains("cycle: is unknown"), "{error}");
}

#[test]
fn waveforms_are_sampled_by_a_clock_of_their_own_or_a_free_one() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    let json = same(folder, &[&["wave.vcd", "wave.vcd"], &CLOCK[..]].concat());
    assert_eq!(json["compared"], 200);
    let late = ["--after", "996ns", "--until", "1.5us"];
    let json = same(folder, &[&["wave.vcd", "wave.vcd"], &CLOCK[..], &late].concat());
    assert_eq!(json["compared"], 50);
    let text = std::fs::read_to_string(folder.join("wave.vcd")).unwrap();
    write(folder, "short.vcd", text.split_once("#1005\n").unwrap().0);
    let json = different(folder, &[&["wave.vcd", "short.vcd"], &CLOCK[..]].concat());
    assert!(json["differences"].to_string().contains("ends after 100 samples"), "{json:#}");
    same(folder, &[&["wave.vcd", "short.vcd"], &CLOCK[..], &["--until", "1us"]].concat());
    let nothing = [&["wave.vcd", "short.vcd"], &CLOCK[..], &["--until", "1ns"]].concat();
    assert!(refused(folder, &nothing).contains("nothing to compare"));
    let free = ["--clock", "100MHz + 5ns"];
    let json = same(folder, &[&["wave.vcd", "wave.vcd"], &free[..]].concat());
    assert_eq!(json["compared"], 200);
    capture(folder, "ila.csv", 11, 50..82);
    let by_trigger = ["--trigger", "go rising"];
    same(folder, &[&["wave.vcd", "ila.csv"], &free[..], &by_trigger].concat());
    same(folder, &[&["wave.vcd", "ila.csv"], &free[..], &["--align", "offset -50"]].concat());
    let error = refused(folder, &["wave.vcd", "ila.csv", "--trigger", "go rising"]);
    assert!(error.contains("say which clock they are taken by with --clock"), "{error}");
    let error = refused(folder, &["wave.vcd", "ila.csv", "--clock", "n"]);
    assert!(error.contains("expected a clock of one bit, not 8"), "{error}");
}

#[test]
fn captures_that_triggered_at_different_places_are_told_apart() {
    let folder = common::empty();
    let folder = folder.path();
    capture(folder, "a.csv", 11, 50..82);
    capture(folder, "b.csv", 1, 60..92);
    let json = different(folder, &["a.csv", "b.csv"]);
    assert!(json["differences"].to_string().contains("trigger at sample 11 of the first, 1 of"));
    assert!(super::differing(&json).is_empty(), "what they share is the same");
}
