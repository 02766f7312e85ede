//! `tofsim budget`: what it says of a shot is what a simulation counts, and of the laser what Table 3.1 does.

use std::fs;

use serde_json::Value;

use crate::common::{empty, json, output, refused, stdout};

/// Columns of `--events` that are looked at.
#[derive(Debug, Default, PartialEq)]
struct Counted {
    shots: f64,
    kept: f64,
    kept_signal: f64,
    coded: f64,
    coded_signal: f64,
}

/// Counts the events of a simulated frame.
fn counted(scenario: &[&str]) -> Counted {
    let folder = empty();
    let run = ["--events", "events.csv", "--waves", "none", "-q"];
    stdout(folder.path(), &[&["run"], scenario, &run].concat());
    let events = fs::read_to_string(folder.path().join("events.csv")).unwrap();
    let mut counted = Counted::default();
    for row in events.lines().skip_while(|line| !line.starts_with("frame,")).skip(1) {
        let row: Vec<_> = row.split(',').collect();
        let &[_, _, _, cause, n, _, code, _] = &row[..] else { panic!("{row:?}") };
        let one = |holds: bool| f64::from(u8::from(holds));
        counted.shots += 1.0;
        counted.kept += one(!n.is_empty());
        counted.kept_signal += one(!n.is_empty() && cause == "signal");
        counted.coded += one(!code.is_empty());
        counted.coded_signal += one(!code.is_empty() && cause == "signal");
    }
    counted
}

fn number(budget: &Value, key: &str) -> f64 {
    budget[key].as_f64().unwrap_or_else(|| panic!("{key}: {}", budget[key]))
}

#[test]
fn the_chances_of_a_shot_are_what_a_simulation_counts() {
    for scenario in [
        &["kc705"][..],
        &["near"],
        &["bright"],
        &["far", "-s", "ambient.irradiance_w_m2_nm=0.02", "-s", "firmware.laser_freq=0"],
        &["kc705", "-s", "target.distance_m=1.2", "-s", "spad.dark_rate_hz=1e8"],
        &["kc705", "-s", "firmware.laser_en=false", "-s", "ambient.irradiance_w_m2_nm=0.01"],
    ] {
        let budget = json(empty().path(), &[&["budget"], scenario, &["--json"]].concat());
        let found = counted(scenario);
        assert_eq!(found.shots, 30_000.0, "{scenario:?}");
        for (key, count) in [
            ("hit_probability", found.kept),
            ("signal_first_probability", found.kept_signal),
            ("counted_hits_per_shot", found.coded),
            ("counted_signal_per_shot", found.coded_signal),
        ] {
            let chance = number(&budget, key);
            let deviation = (found.shots * chance * (1.0 - chance)).max(0.0).sqrt();
            let off = (count - found.shots * chance).abs();
            // The last shot of a frame has a longer window.
            let most = 4.5 * deviation + 1.0;
            assert!(off < most, "{scenario:?} {key}: {chance}, counted {count} of 30,000");
        }
        let noise = found.coded - found.coded_signal;
        let ratio = number(&budget, "signal_to_noise");
        let off = (ratio - found.coded_signal / noise).abs();
        assert!(off <= ratio * 5.0 * (1.0 / noise + 1.0 / found.coded_signal.max(1.0)).sqrt());
    }
}

#[test]
fn where_shots_depend_on_each_other_there_is_no_chance_to_tell() {
    let args = ["budget", "-s", "firmware.mode=1"];
    assert!(
        stdout(empty().path(), &args)
            .contains("known only where the first avalanche of a shot decides")
    );
    let budget = json(empty().path(), &[&args[..], &["--json"]].concat());
    assert!(budget["hit_probability"].is_null() && budget["signal_to_noise"].is_null());
    assert!(number(&budget, "signal_per_shot") > 0.0);
}

#[test]
fn a_verdict_says_whether_the_laser_is_within_class_1_and_for_how_long() {
    let budget = |power: &str| {
        let power = format!("laser.average_power_w={power}");
        json(empty().path(), &["budget", "--json", "-q", "-s", &power])
    };
    let keys = |budget: &Value| -> Vec<String> {
        let notes = budget["notes"].as_array().unwrap();
        assert!(notes.iter().all(|note| note["code"] == "eye-safety"), "{notes:?}");
        notes.iter().map(|note| note["text"].as_str().unwrap().to_owned()).collect()
    };
    let default = budget("7.36e-3");
    let (frame, repeated) = (&default["eye_safety"], &default["eye_safety"]["repeated"]);
    assert!((number(frame, "limit_w") / 10.85e-3 - 1.0).abs() < 1e-3);
    assert!((number(frame, "average_w") / 3.833e-3 - 1.0).abs() < 1e-3);
    assert_eq!(frame["within"], true);
    assert!((number(repeated, "limit_w") / 1.1888e-3 - 1.0).abs() < 1e-3, "Table 3.1 at 10 s");
    assert_eq!((number(repeated, "exposure_s"), &repeated["within"]), (10.0, &false.into()));
    assert!((number(repeated, "longest_s") - 0.094).abs() < 1e-3);
    let notes = keys(&default);
    assert!(notes.len() == 1 && notes[0].starts_with("frames that repeat"), "{notes:?}");

    let bright = budget("0.1");
    assert!((number(&bright["eye_safety"], "average_w") / 52.08e-3 - 1.0).abs() < 1e-3);
    assert_eq!(bright["eye_safety"]["within"], false);
    assert!(bright["eye_safety"]["repeated"]["longest_s"].is_null());
    assert_eq!(keys(&bright).len(), 3, "a frame, ten seconds of them, and the pulses");

    let dim = budget("2e-3");
    assert_eq!(dim["eye_safety"]["repeated"]["within"], true);
    assert!(keys(&dim).is_empty());
}

#[test]
fn a_laser_above_class_1_is_said_on_stderr_and_refused_when_strict() {
    let args = ["budget", "-s", "laser.average_power_w=0.1"];
    let found = output(empty().path(), &args);
    let (table, console) = (String::from_utf8(found.stdout), String::from_utf8(found.stderr));
    let table = table.unwrap();
    assert!(
        table.contains(
            " eye safety            above        52.08 of 10.85 mW, Class 1 for one frame"
        )
    );
    let console = console.unwrap();
    assert!(console.contains("note: laser.average_power_w = 0.1: a frame: 52.08 mW"), "{console}");
    assert!(refused(empty().path(), &[&args[..], &["--strict"]].concat()).contains("--strict"));
    let dim = ["budget", "--strict", "-s", "laser.average_power_w=2e-3"];
    assert!(
        stdout(empty().path(), &dim).contains(" within       1.04 of 1.19 mW, Class 1 for 10 s of")
    );
    let slow = ["budget", "--strict", "-s", "laser.repetition_rate_hz=1000"];
    let error = refused(empty().path(), &slow);
    assert!(
        error.contains("laser.repetition_rate_hz = 1000: eq. 3.3: no Class 1 limit"),
        "{error}"
    );
}

#[test]
fn a_budget_says_which_keys_were_set() {
    let set = ["budget", "--json", "-q", "-s", "target.distance_m=0.3", "-s", "seed=7"];
    let budget = json(empty().path(), &set);
    assert_eq!(budget["set"], serde_json::json!(["target.distance_m=0.3", "seed=7"]));
}

#[test]
fn ambient_light_in_klux_is_converted_and_never_stated_twice() {
    let folder = empty();
    let klux = ["-s", "ambient.illuminance_klux=14"];
    let shown = stdout(folder.path(), &[&["scenario", "show"], &klux[..]].concat());
    let line = shown.lines().find(|line| line.starts_with("irradiance_w_m2_nm = ")).unwrap();
    let watts: f64 = line.rsplit(' ').next().unwrap().parse().unwrap();
    assert!((watts - 0.582).abs() < 1e-3, "{line}");
    let noise = |set: &[&str]| {
        let budget = json(folder.path(), &[&["budget", "--json", "-q"], set].concat());
        number(&budget, "noise_rate_hz")
    };
    assert_eq!(noise(&klux), noise(&["-s", &format!("ambient.irradiance_w_m2_nm={watts:?}")]));
    let both = "[ambient]\nilluminance_klux = 14\nirradiance_w_m2_nm = 0.1\n";
    fs::write(folder.path().join("both.toml"), both).unwrap();
    let error = refused(folder.path(), &["scenario", "check", "both.toml"]);
    assert!(error.contains("both.toml:2:20: ambient.illuminance_klux = 14"), "{error}");
    assert!(error.contains("ambient.irradiance_w_m2_nm is given too"), "{error}");
}

#[test]
fn a_chain_that_is_too_short_is_refused() {
    let folder = empty();
    fs::write(folder.path().join("short.toml"), "offset_ps = 2230\ntap_ps = 5\n").unwrap();
    let args = ["run", "--waves", "none", "-s", "tdc.profile=short.toml"];
    // The profile of a built-in scenario is looked for where the program was started.
    let error = refused(folder.path(), &args);
    assert!(error.contains("tap_ps = 5: the 800 taps take 4000 ps, expected 8 ns"), "{error}");
}
