//! Captures of several windows, with gaps and marks.

use crate::common;

use super::align::{CLOCK, args, capture, waveform, windows};
use super::{csv, different, differing, same, vcd, write};

/// Windows of one column each, without triggers unless there is a `t` behind the value.
fn column(windows: &[&str]) -> String {
    let mut text = String::from(
        "Sample in Buffer,Sample in Window,TRIGGER,n[3:0]\nRadix - UNSIGNED,UNSIGNED,UNSIGNED,HEX\n",
    );
    let mut buffer = 0;
    for window in windows {
        for (place, cell) in window.split(' ').enumerate() {
            let (value, trigger) = (cell.trim_end_matches('t'), u8::from(cell.ends_with('t')));
            text += &format!("{buffer},{place},{trigger},{value}\n");
            buffer += 1;
        }
    }
    text
}

#[test]
fn windows_that_triggered_at_different_places_share_what_lies_around_it() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &windows(&[(20..28, 3), (70..78, 3)]));
    write(folder, "b.csv", &windows(&[(22..30, 1), (69..77, 4)]));
    let json = different(folder, &["a.csv", "b.csv"]);
    assert!(differing(&json).is_empty(), "{json:#}");
    assert_eq!((&json["compared"], json["offset"].is_null()), (&13.into(), true));
    let text = json["differences"].to_string();
    for part in
        ["window 0: trigger at sample 3 of the first, 1", "window 1: trigger at sample 3 of"]
    {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn what_changes_between_windows_is_compared_in_the_next() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &column(&["1 1t 1 1", "1 1t 1 1"]));
    write(folder, "b.csv", &column(&["1 1t 1 1", "2 2 2t 2"]));
    for files in [["a.csv", "b.csv"], ["b.csv", "a.csv"]] {
        let json = different(folder, &files);
        assert_eq!((&json["first"]["differing"], &json["compared"]), (&3.into(), &7.into()));
    }
}

#[test]
fn windows_without_triggers_come_together_from_their_begins() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &column(&["1 2 3 4", "5 6 7 8", "9 a b c"]));
    write(folder, "b.csv", &column(&["1 2 3 4", "5 6 7"]));
    let json = different(folder, &["a.csv", "b.csv"]);
    assert!(differing(&json).is_empty() && json["compared"] == 7, "{json:#}");
    let text = json["differences"].to_string();
    for part in [
        "the first has 3 windows, the second 2",
        "window 1: 4 samples in the first, 3 in the second",
        "window 1: b.csv ends after 3 samples, before a.csv does",
    ] {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn a_capture_that_goes_on_after_the_waveform_is_told() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder);
    capture(folder, "ila.csv", 3, 168..200);
    same(folder, &args(&["--align", "offset -168"]));
    capture(folder, "ila.csv", 3, 169..201);
    for files in [["wave.vcd", "ila.csv"], ["ila.csv", "wave.vcd"]] {
        let offset = if files[0] == "wave.vcd" { "offset -169" } else { "offset 169" };
        let json = different(folder, &[&files[..], &CLOCK, &["--align", offset]].concat());
        let text = json["differences"].to_string();
        assert!(text.contains("wave.vcd ends after 31 samples, before ila.csv does"), "{text}");
        assert!(differing(&json).is_empty());
    }
}

#[test]
fn a_latency_begins_anew_with_each_window() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &column(&["1 2 3 4", "9 a b c"]));
    write(folder, "b.csv", &column(&["f 1 2 3", "f 9 a b"]));
    let json = same(folder, &["a.csv", "b.csv", "--latency", "n=1"]);
    assert_eq!(json["signals"][0]["compared"], 6);
    let json = same(folder, &["b.csv", "a.csv", "--latency", "n=-1"]);
    assert_eq!(json["signals"][0]["compared"], 6);
}

#[test]
fn a_difference_behind_a_latency_is_at_each_side_s_own_sample() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &column(&["1 2 3 4 5"]));
    write(folder, "b.csv", &column(&["0 0 1 7 3"]));
    let at = |args: &[&str]| different(folder, args)["first"]["first"]["at"].to_string();
    assert_eq!(at(&["a.csv", "b.csv", "--latency", "n=2"]), "[1.0,3.0]");
    assert_eq!(at(&["b.csv", "a.csv", "--latency", "n=-2"]), "[3.0,1.0]");
}

#[test]
fn a_signal_that_comes_late_counts_where_the_first_side_is_valid() {
    let folder = common::empty();
    let folder = folder.path();
    let table = |cells: &[&str]| {
        csv("ok,n[3:0]", "HEX,HEX", 0, &cells.iter().map(|&c| c.to_owned()).collect::<Vec<_>>())
    };
    write(folder, "a.csv", &table(&["1,1", "0,2", "1,3", "0,4"]));
    write(folder, "b.csv", &table(&["1,0", "0,1", "1,f", "0,3"]));
    same(folder, &["a.csv", "b.csv", "--latency", "n=1", "--valid", "n=ok"]);
    write(folder, "a.csv", &table(&["1,0", "0,f", "1,1", "0,e", "1,3"]));
    write(folder, "b.csv", &table(&["1,8", "0,1", "1,2", "0,3", "1,4"]));
    same(folder, &["a.csv", "b.csv", "--latency", "n=-1", "--valid", "n=ok"]);
}

#[test]
fn samples_that_are_missing_are_not_compared() {
    let folder = common::empty();
    let folder = folder.path();
    let head = "Sample in Buffer,Sample in Window,TRIGGER,GAP,n[3:0]\n\
        Radix - UNSIGNED,UNSIGNED,UNSIGNED,HEX\n";
    let rows = "0,0,0,0,1\n1,1,0,0,2\n2,2,0,1,X\n3,3,0,0,4\n4,4,0,0,5\n";
    write(folder, "a.csv", &format!("{head}{rows}"));
    write(folder, "b.csv", &column(&["1 2 3 4 5"]));
    for files in [["a.csv", "b.csv"], ["b.csv", "a.csv"]] {
        assert_eq!(same(folder, &files)["compared"], 4);
    }
    // Behind a latency, only what has lost its partner.
    write(folder, "b.csv", &column(&["f 1 2 3 4"]));
    let late = ["a.csv", "b.csv", "--latency", "n=1"];
    assert_eq!(same(folder, &late)["signals"][0]["compared"], 3);
    let early = ["b.csv", "a.csv", "--latency", "n=-1"];
    assert_eq!(same(folder, &early)["signals"][0]["compared"], 3);
    write(folder, "b.csv", &column(&["f 1 7 3 4"]));
    let json = different(folder, &late);
    assert_eq!(json["first"]["first"]["at"].to_string(), "[1.0,2.0]");
}

/// Two windows of four samples that triggered at their first and their second.
#[test]
fn marks_that_change_and_marks_that_are_high_for_a_sample_say_the_same() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &column(&["1t 2 3 4", "5 6t 7 8"]));
    let body = |marks: [&str; 8]| {
        let rows = marks.iter().enumerate();
        rows.map(|(k, marks)| format!("#{k}\n{marks}b{:b} c\n", k + 1)).collect::<String>()
    };
    let variables = [(1, "_TRIGGER"), (1, "_WINDOW"), (4, "n [3:0]")];
    let changing = body(["1a\n1b\n", "", "", "", "0b\n", "0a\n", "", ""]);
    let high = body(["1a\n0b\n", "0a\n", "", "", "1b\n", "1a\n", "0a\n", ""]);
    let vcds = [
        vcd("1ps", "dut", &variables, &changing),
        vcd("1ps", "dut", &variables, &high),
        format!("$version Chipscopy 2024 $end\n{}", vcd("1ps", "dut", &variables, &high)),
    ];
    for text in vcds {
        write(folder, "b.vcd", &text);
        let json = same(folder, &["a.csv", "b.vcd"]);
        assert_eq!(json["compared"], 8);
        assert_eq!(json["alignment"], "by the trigger of 2 windows");
        let other = column(&["1t 2 3 4", "5 6 7t 8"]);
        write(folder, "other.csv", &other);
        let json = different(folder, &["other.csv", "b.vcd"]);
        assert!(json["differences"].to_string().contains("at sample 2 of the first, 1 of the"));
    }
}
