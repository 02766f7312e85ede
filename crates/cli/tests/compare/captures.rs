//! Captures of the built-in set-ups, in every format, against the run they are of.

use std::path::Path;

use crate::common;

use super::{refused, same};

/// A set-up, and the waveform of the run: scenario, frames, window, signals, what is set.
type SetUp =
    (&'static str, &'static str, &'static str, &'static str, &'static [&'static str], &'static str);

const SET_UPS: [SetUp; 5] = [
    ("fig_6_6", "kc705", "1", "9us..16us", &[], "seed=1"),
    ("fig_6_12", "histogram_validation", "1", "0us..14us", &[], "seed=1"),
    ("fig_6_13", "histogram_validation", "1", "1319us..1337.6us", &["*", "ram_*"], "seed=1"),
    ("fig_6_21", "estimator_validation", "3", "0us..13us", &[], "seed=1"),
    (
        "likelihood_estimator",
        "estimator_validation",
        "2",
        "0us..40us",
        &[],
        "estimator.kind=likelihood",
    ),
];
const FORMATS: [&str; 3] = ["csv", "vcd", "ila"];

fn capture(folder: &Path, set_up: &str) {
    common::stdout(folder, &["ila", "capture", "--probes", set_up, "-o", "."]);
}

fn run(folder: &Path, (_, scenario, frames, window, signals, set): SetUp) {
    let mut args = vec!["run", scenario, "--frames", frames, "--window", window, "-o", "."];
    args.extend(["-s", set]);
    signals.iter().for_each(|glob| args.extend(["--signals", glob]));
    common::stdout(folder, &args);
}

#[test]
fn each_set_up_in_each_format_is_the_waveform_of_its_run() {
    for set_up in SET_UPS {
        let folder = common::empty();
        let folder = folder.path();
        capture(folder, set_up.0);
        run(folder, set_up);
        let waveform = format!("{}.vcd", set_up.1);
        let map = format!("{}.map.toml", set_up.0);
        for format in FORMATS {
            let file = format!("{}.{format}", set_up.0);
            for map in [set_up.0, &map] {
                let json = same(folder, &[&waveform, &file, "--map", map]);
                assert!(json["compared"].as_u64().unwrap() > 500, "{file}: {json:#}");
                let probes = common::json(folder, &["ila", "info", &file, "--json"]);
                let probes = probes["probes"].as_array().unwrap().len();
                assert_eq!(json["signals"].as_array().unwrap().len(), probes);
            }
        }
    }
}

#[test]
fn a_capture_is_the_same_as_a_simulation_on_the_fly() {
    for (set_up, scenario, frames, _, _, set) in SET_UPS {
        let folder = common::empty();
        capture(folder.path(), set_up);
        let file = format!("{set_up}.ila");
        let args = ["--scenario", scenario, "--frames", frames, &file, "--map", set_up, "-s", set];
        same(folder.path(), &args);
    }
}

#[test]
fn captures_of_one_set_up_in_two_formats_compare_without_options() {
    for (set_up, ..) in SET_UPS {
        let folder = common::empty();
        capture(folder.path(), set_up);
        for a in FORMATS {
            for b in FORMATS {
                let files = [a, b].map(|format| format!("{set_up}.{format}"));
                let json = same(folder.path(), &[&files[0], &files[1]]);
                let whole = if (a, b) == ("vcd", "vcd") { 500 } else { 1024 };
                assert!(json["compared"].as_u64().unwrap() >= whole, "{json:#}");
            }
        }
    }
}

#[test]
fn several_windows_come_together_by_their_triggers() {
    let folder = common::empty();
    let folder = folder.path();
    let args = ["ila", "capture", "--probes", "fig_6_12", "--windows", "8", "--position", "5"];
    common::stdout(folder, &[&args[..], &["-o", "."]].concat());
    common::stdout(folder, &["run", "histogram_validation", "--window", "0us..30us", "-o", "."]);
    let info = common::json(folder, &["ila", "info", "fig_6_12.csv", "--json"]);
    assert_eq!((&info["windows"], &info["triggers"]), (&8.into(), &8.into()));
    for format in FORMATS {
        let file = format!("fig_6_12.{format}");
        let json = same(folder, &["histogram_validation.vcd", &file, "--map", "fig_6_12"]);
        assert!(json["compared"].as_u64().unwrap() >= 900, "{json:#}");
        same(folder, &["fig_6_12.ila", &file]);
    }
}

#[test]
fn a_window_that_the_run_s_end_cut_short_is_compared_as_far_as_it_goes() {
    let folder = common::empty();
    let folder = folder.path();
    let scenario = ["-s", "firmware.shots_per_frame=40"];
    let capture = ["ila", "capture", "kc705", "--probes", "fig_6_6", "-o", ".", "--windows", "4"];
    let trigger = ["--trigger", "SPAD_RST_DO == 0"];
    let more = ["--position", "16", "--arm-at-us", "0", "--depth", "2048"];
    common::stdout(folder, &[&capture[..], &scenario, &trigger, &more].concat());
    let info = common::json(folder, &["ila", "info", "fig_6_6.csv", "--json"]);
    assert_eq!((&info["windows"], &info["triggers"]), (&4.into(), &4.into()));
    assert!(info["samples"].as_u64().unwrap() < 2048, "{info:#}");
    for format in FORMATS {
        let file = format!("fig_6_6.{format}");
        let args = ["--scenario", "kc705", &file, "--map", "fig_6_6.map.toml"];
        same(folder, &[&args[..], &scenario].concat());
    }
}

#[test]
fn input_stages_and_a_free_clock_come_with_the_map() {
    let folder = common::empty();
    let folder = folder.path();
    let args = ["ila", "capture", "--probes", "fig_6_12", "--stages", "3", "-o", "."];
    let args = [&args[..], &["--clock", "90MHz + 1500ps", "--arm-at-us", "4"]].concat();
    common::stdout(folder, &args);
    common::stdout(folder, &["run", "histogram_validation", "--window", "0us..20us", "-o", "."]);
    let map = ["--map", "fig_6_12.map.toml"];
    same(folder, &[&["histogram_validation.vcd", "fig_6_12.csv"][..], &map].concat());
}

#[test]
fn a_periodic_capture_is_ambiguous_by_correlation_alone() {
    let folder = common::empty();
    let folder = folder.path();
    capture(folder, "fig_6_6");
    let args = ["--scenario", "kc705", "fig_6_6.csv", "--map", "fig_6_6"];
    let error = refused(folder, &[&args[..], &["--align", "correlation"]].concat());
    assert!(error.contains("ambiguous") && error.contains("(0 of 2048 bits differ)"), "{error}");
}

#[test]
fn the_sides_may_be_exchanged() {
    let folder = common::empty();
    let folder = folder.path();
    capture(folder, "fig_6_21");
    run(folder, SET_UPS[3]);
    let files = ["fig_6_21.csv", "estimator_validation.vcd"];
    let json = same(folder, &[&files[..], &["--map", "fig_6_21"]].concat());
    assert_eq!(json["notes"][0]["code"], "comparison", "{json:#}");
    assert!(json["notes"].to_string().contains("exchanged"), "{json:#}");
    assert!(json["hash"].is_null() && json["set"].as_array().unwrap().is_empty());
    let simulated = ["--scenario", "estimator_validation", "fig_6_21.csv", "--map", "fig_6_21"];
    let done = common::output(folder, &[&["compare", "--json"], &simulated[..]].concat());
    let json: serde_json::Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!(json["notes"][0]["code"], "no-light", "{json:#}");
    assert_eq!(json["scenario"], "estimator_validation");
    assert_eq!(json["hash"].as_str().unwrap().len(), 16);
}
