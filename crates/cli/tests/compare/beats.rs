//! The words that a bus accepts, compared whenever they come.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common;

use super::{different, refused, same, vcd, write};

const ACCEPTED: [&str; 2] = ["--beats", "valid && ready"];
const CLOCK: [&str; 2] = ["--clock", "clk"];

/// Numbers that look random.
struct Random(u64);

impl Random {
    fn below(&mut self, below: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 33) % below
    }
}

fn words(count: usize) -> Vec<u64> {
    let mut random = Random(7);
    (0..count).map(|_| random.below(1 << 16)).collect()
}

/// Returns the signals of a bus that accepts the words, cycle by cycle, with `stalls` stalls in ten cycles.
fn cycles(words: &[u64], stalls: u64, seed: u64) -> Vec<(bool, bool, u64)> {
    let mut random = Random(seed);
    let mut left = words.iter().peekable();
    let mut cycles = Vec::new();
    while let Some(&&word) = left.peek() {
        let [valid, ready] = [0, 1].map(|_| random.below(10) >= stalls);
        let data = if valid { word } else { random.below(1 << 16) };
        cycles.push((valid, ready, data));
        if valid && ready {
            left.next();
        }
    }
    cycles
}

fn waveform(folder: &Path, name: &str, words: &[u64], stalls: u64) {
    let mut body = "#0\n0a\n0b\n0c\nb0 d\n".to_owned();
    for (k, (valid, ready, data)) in cycles(words, stalls, 3).into_iter().enumerate() {
        let at = 10 * k + 10;
        let [valid, ready] = [valid, ready].map(u8::from);
        body += &format!("#{at}\n0a\n{valid}b\n{ready}c\nb{data:b} d\n#{}\n1a\n", at + 5);
    }
    let variables = [(1, "clk"), (1, "valid"), (1, "ready"), (16, "data")];
    write(folder, name, &vcd("1ns", "top", &variables, &body));
}

/// A capture of windows of 256 samples, each of which begins with some words.
fn capture(folder: &Path, name: &str, windows: &[&[u64]], stalls: u64) {
    let mut text = "Sample in Buffer,Sample in Window,TRIGGER,valid,ready,data[15:0]\n\
        Radix - UNSIGNED,UNSIGNED,UNSIGNED,HEX,HEX,HEX\n"
        .to_owned();
    for (window, words) in windows.iter().enumerate() {
        let idle = std::iter::repeat((false, true, 5));
        let rows = cycles(words, stalls, 9 + window as u64).into_iter().chain(idle).take(256);
        for (k, (valid, ready, data)) in rows.enumerate() {
            let [valid, ready, trigger] = [valid, ready, k == 3].map(u8::from);
            text += &format!("{},{k},{trigger},{valid},{ready},{data:04x}\n", 256 * window + k);
        }
    }
    write(folder, name, &text);
}

fn args<'a>(files: [&'a str; 2], more: &[&'a str]) -> Vec<&'a str> {
    [&files, &ACCEPTED[..], more].concat()
}

/// The kinds of the differences, and how many beats are the same.
fn kinds(json: &Value) -> (Vec<&str>, u64) {
    let list = json["beats"]["list"].as_array().unwrap().iter();
    let kinds = list.map(|beat| beat["kind"].as_str().unwrap()).collect();
    (kinds, json["beats"]["same"].as_u64().unwrap())
}

#[test]
fn stalls_are_no_difference() {
    let folder = common::empty();
    let folder = folder.path();
    let words = words(2000);
    waveform(folder, "a.vcd", &words, 0);
    waveform(folder, "b.vcd", &words, 5);
    capture(folder, "ila.csv", &[&words[500..600], &words[640..700], &words[1500..1600]], 2);
    let json = same(folder, &args(["a.vcd", "b.vcd"], &CLOCK));
    assert_eq!(kinds(&json), (vec![], 2000));
    assert_eq!(json["beats"]["signals"], serde_json::json!(["top.data"]));
    assert_eq!(json["signals"].as_array().unwrap().len(), 1);
    let json = same(folder, &args(["a.vcd", "ila.csv"], &CLOCK));
    assert_eq!(kinds(&json), (vec![], 260));
    assert_eq!(json["beats"]["outside"], serde_json::json!([1740, 0]));
    assert!(json["alignment"].as_str().unwrap().contains("from beat 500, beat 640, beat 1500"));
    same(folder, &args(["ila.csv", "b.vcd"], &CLOCK));
    // The map says it too.
    write(folder, "map.toml", "clock = \"top.clk\"\nbeats = \"valid && ready\"\n");
    let json = same(folder, &["a.vcd", "ila.csv", "--map", "map.toml"]);
    assert_eq!(kinds(&json), (vec![], 260));
}

#[test]
fn lost_repeated_extra_and_changed_words_are_named_with_their_places() {
    let folder = common::empty();
    let folder = folder.path();
    let words = words(400);
    waveform(folder, "a.vcd", &words, 0);
    type Fault = fn(&mut Vec<u64>);
    let faults: [(&str, Fault); 4] = [
        ("lost", |words| _ = words.remove(100)),
        ("repeated", |words| words.insert(100, words[100])),
        ("extra", |words| words.insert(100, 0xabcd)),
        ("changed", |words| words[100] ^= 4),
    ];
    for (kind, fault) in faults {
        let mut faulty = words.clone();
        fault(&mut faulty);
        waveform(folder, "b.vcd", &faulty, 3);
        capture(folder, "ila.csv", &[&faulty[40..160]], 2);
        for file in ["b.vcd", "ila.csv"] {
            let json = different(folder, &args(["a.vcd", file], &CLOCK));
            let of_all = if file == "b.vcd" { words.len() as u64 } else { 120 };
            let same =
                of_all - u64::from(kind != "repeated" && kind != "extra" || file == "ila.csv");
            let same = same + u64::from(kind == "lost" && file == "ila.csv");
            assert_eq!(kinds(&json), (vec![kind], same), "{file}");
            assert_eq!(json["beats"][kind], 1);
        }
        let output =
            common::output(folder, &[&["compare"], &args(["a.vcd", "b.vcd"], &CLOCK)[..]].concat());
        let text = String::from_utf8(output.stdout).unwrap();
        let place = if kind == "repeated" { "1025 ns, sample 101" } else { "1015 ns, sample 100" };
        assert!(text.contains(&format!("first     {kind} word at {place} / ")), "{text}");
    }
    // The first and the last word of a window, which have nothing before or after them.
    let mut faulty = words[100..200].to_vec();
    (faulty[0], faulty[99]) = (1, 2);
    capture(folder, "ila.csv", &[&faulty], 1);
    let json = different(folder, &args(["a.vcd", "ila.csv"], &CLOCK));
    assert_eq!(kinds(&json), (vec!["changed", "changed"], 98));
    assert_eq!(json["beats"]["list"][0]["beats"][0]["at"], 1015.0 * 1000.0);
    let place = &json["beats"]["list"][0]["beats"][1];
    assert_eq!(
        (&place["beat"], &place["sample"], &place["at"]),
        (&0.into(), &0.into(), &0.0.into())
    );
}

#[test]
fn captures_need_not_begin_at_the_same_word() {
    let folder = common::empty();
    let folder = folder.path();
    let words = words(300);
    capture(folder, "a.csv", &[&words[0..100], &words[200..250]], 2);
    capture(folder, "b.csv", &[&words[30..130], &words[190..240]], 3);
    let json = same(folder, &args(["a.csv", "b.csv"], &[]));
    assert_eq!(kinds(&json), (vec![], 110));
    assert_eq!(json["beats"]["outside"], serde_json::json!([40, 40]));
    capture(folder, "b.csv", &[&words[30..130]], 3);
    let json = different(folder, &args(["a.csv", "b.csv"], &[]));
    assert!(json["differences"][0].as_str().unwrap().contains("2 windows, the second 1"));
}

#[test]
fn a_place_that_is_not_clear_is_said() {
    let folder = common::empty();
    let folder = folder.path();
    let periodic: Vec<u64> = (0..600).map(|k| k % 6).collect();
    waveform(folder, "a.vcd", &periodic, 0);
    capture(folder, "ila.csv", &[&periodic[30..120]], 1);
    let files = ["a.vcd", "ila.csv"];
    let error = refused(folder, &args(files, &CLOCK));
    assert!(error.contains("window 0 is ambiguous, its words come at several places"), "{error}");
    capture(folder, "ila.csv", &[&words(90)], 1);
    let error = refused(folder, &args(files, &CLOCK));
    assert!(error.contains("window 0 fits nowhere"), "{error}");
    let error = refused(folder, &args(files, &[]));
    assert!(error.contains("say which clock they are taken by with --clock"), "{error}");
}

#[test]
fn what_cannot_go_with_beats_is_refused_by_name() {
    let folder = common::empty();
    let folder = folder.path();
    waveform(folder, "a.vcd", &words(40), 0);
    fs::copy(folder.join("a.vcd"), folder.join("b.vcd")).unwrap();
    let refused =
        |more: &[&str]| refused(folder, &args(["a.vcd", "b.vcd"], &[&CLOCK, more].concat()));
    for (option, value) in [
        ("--align", "start"),
        ("--trigger", "valid"),
        ("--time-from", "data"),
        ("--qualified-by", "valid"),
        ("--waves", "c.vcd"),
        ("--x", "any"),
    ] {
        let error = refused(&[option, value]);
        assert!(error.contains(option) && error.contains("cannot go with --beats"), "{error}");
    }
    for (option, value, what) in [
        ("--latency", "data=1", "a latency"),
        ("--tolerance", "data=1", "a tolerance"),
        ("--valid", "data=ready", "`valid`"),
    ] {
        let error = refused(&[option, value]);
        assert!(error.contains(&format!("data: has {what}, which cannot go")), "{error}");
    }
    let error = refused(&["--signals", "clk"]);
    assert!(error.contains("no signal is compared but those of the condition"), "{error}");
    let never = ["compare", "a.vcd", "b.vcd", "--clock", "clk", "--beats", "data == 0xffff"];
    let error = common::refused(folder, &never);
    assert!(error.contains("has no beat: the condition never holds"), "{error}");
    // Bits that are not compared and a bus the other way round are.
    write(folder, "map.toml", "[[signal]]\na = [\"data\"]\ndont_care = \"0xff\"\n");
    let other: Vec<u64> = words(40).iter().map(|word| word ^ 0x5a).collect();
    waveform(folder, "b.vcd", &other, 4);
    same(folder, &args(["a.vcd", "b.vcd"], &[&CLOCK[..], &["--map", "map.toml"]].concat()));
    different(folder, &args(["a.vcd", "b.vcd"], &CLOCK));
    write(folder, "map.toml", "[[signal]]\na = [\"data\"]\ninvert = true\n");
    let other: Vec<u64> = words(40).iter().map(|word| word ^ 0xffff).collect();
    waveform(folder, "b.vcd", &other, 4);
    same(folder, &args(["a.vcd", "b.vcd"], &[&CLOCK[..], &["--map", "map.toml"]].concat()));
}

#[test]
fn a_simulation_s_codes_are_those_of_a_board_that_was_stopped_now_and_then() {
    let folder = common::empty();
    let folder = folder.path();
    common::stdout(
        folder,
        &["ila", "capture", "--probes", "fig_6_12", "-o", ".", "--format", "csv"],
    );
    // The board's logger leaves out cycles without a code, here and there.
    let text = fs::read_to_string(folder.join("fig_6_12.csv")).unwrap();
    let mut rows: Vec<String> = text.lines().map(str::to_owned).collect();
    let idle =
        |row: &String| row.split(',').nth(4) == Some("0") && row.split(',').nth(2) == Some("0");
    let mut k = 0;
    rows.retain(|row| {
        k += 1;
        k < 100 || k % 7 != 0 || !idle(row)
    });
    for (number, row) in rows.iter_mut().skip(2).enumerate() {
        let rest = row.splitn(3, ',').nth(2).unwrap().to_owned();
        *row = format!("{number},{number},{rest}");
    }
    write(folder, "board.csv", &(rows.join("\n") + "\n"));
    let run = ["--scenario", "histogram_validation", "board.csv", "--map", "fig_6_12"];
    let beats = ["--beats", "TDC_VALID", "--signals", "*tdc_code"];
    different(folder, &run);
    let json = same(folder, &[&run[..], &beats].concat());
    assert!(json["beats"]["same"].as_u64().unwrap() > 160, "{json:#}");
}
