//! `tofsim spad`: tables, JSON, files that can be made again.

use crate::common::{empty, json, refused, stdout};

const COUNTS: [&str; 3] = ["spad", "--counts", "5000"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&COUNTS, more].concat()
}

#[test]
fn a_diode_with_afterpulses_is_told_from_one_without() {
    let folder = empty();
    let here = folder.path();
    let plain = json(here, &with(&["--json"]));
    assert_eq!(
        (&plain["schema"], &plain["set"]),
        (&"tofsim.spad/1".into(), &serde_json::json!([]))
    );
    assert_eq!(plain["rates"].as_array().unwrap().len(), 9);
    assert!(plain["faint_light"]["probability"].is_null());
    assert!(plain["rates"][0]["with_afterpulses_hz"].is_null());
    let set = ["-s", "spad.afterpulse_probability=0.2", "-s", "spad.temperature_c=28"];
    let own = json(here, &with(&[&set[..], &["--json"]].concat()));
    let probability = &own["faint_light"]["probability"];
    let [p, se] = ["value", "se"].map(|key| probability[key].as_f64().unwrap());
    assert!((p - 0.2).abs() < 4.0 * se && se < 0.03, "{p} {se}");
    assert_eq!(own["expected_dark_rate_hz"], 200.0);
    let text = stdout(here, &with(&set));
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(text.contains("afterpulse probability") && text.contains("dark rate"), "{text}");
}

#[test]
fn traps_of_two_kinds_have_a_mean_time_and_tell_no_probability() {
    let folder = empty();
    let set = [
        "-s",
        "spad.afterpulse_probability=0.2",
        "-s",
        "spad.afterpulse_second_share=0.5",
        "-s",
        "spad.afterpulse_second_ns=200",
    ];
    let text = stdout(folder.path(), &with(&set));
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    assert!(text.contains("mean time after it"), "{text}");
    assert!(text.contains("unknown: the mean is over two time constants"), "{text}");
    let found = json(folder.path(), &with(&[&set[..], &["--json"]].concat()));
    let faint = &found["faint_light"];
    assert!(faint["probability"].is_null() && !faint["time_constant_s"].is_null(), "{faint}");
    let [first, second] = [50.0f64, 200.0].map(|ns| (-20.0 / ns).exp() / 2.0);
    let expected_s = (first * 50e-9 + second * 200e-9) / (first + second);
    let found_s = faint["expected_time_constant_s"].as_f64().unwrap();
    assert!((found_s / expected_s - 1.0).abs() < 1e-9, "{found_s} {expected_s}");
    let chance = faint["expected_after_dead_time"].as_f64().unwrap();
    assert!((chance - 0.2 * (first + second)).abs() < 1e-12, "{chance}");
}

#[test]
fn its_files_can_be_made_again() {
    let folder = empty();
    let here = folder.path();
    stdout(here, &with(&["-s", "spad.afterpulse_probability=0.1", "-o", "out"]));
    for name in [
        "spad.json",
        "rates.csv",
        "intervals.csv",
        "autocorrelation.csv",
        "rates.svg",
        "intervals.svg",
        "autocorrelation.svg",
    ] {
        let path = format!("out/{name}");
        assert_eq!(stdout(here, &["rerun", &path]), format!("{path}: the same\n"));
    }
}

#[test]
fn what_a_diode_cannot_be_is_refused() {
    let folder = empty();
    let refused = |set: &str| refused(folder.path(), &["spad", "-s", set]);
    for (set, expected) in [
        ("spad.afterpulse_probability=1", "expected less than 1: with 1 the afterpulses"),
        ("spad.afterpulse_probability=1.5", "from 0.0 to 1.0"),
        ("spad.afterpulse_probability=nan", "spad.afterpulse_probability = nan"),
        ("spad.afterpulse_probability=-0.1", "from 0.0 to 1.0"),
        ("spad.crosstalk_probability=1.01", "from 0.0 to 1.0"),
        ("spad.crosstalk_probability=nan", "spad.crosstalk_probability = nan"),
        ("spad.temperature_c=-55.1", "from -55.0 to 125.0"),
        ("spad.temperature_c=126", "from -55.0 to 125.0"),
        ("spad.dark_doubling_c=0", "spad.dark_doubling_c = 0"),
        ("spad.afterpulse_ns=0", "spad.afterpulse_ns = 0"),
        ("spad.afterpulse_second_ns=0", "spad.afterpulse_second_ns = 0"),
        ("spad.afterpulse_second_share=1.1", "from 0.0 to 1.0"),
        ("spad.dead_time_kind=slow", "spad.dead_time_kind"),
    ] {
        let error = refused(set);
        assert!(error.contains(expected), "{set}: {error}");
    }
}
