//! The whole row of the array, measured dark rates and shaped pulses, from the command line.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{empty, json, output, refused};

fn with<'a>(args: &[&'a str], keys: &[&'a str]) -> Vec<&'a str> {
    args.iter().copied().chain(keys.iter().flat_map(|key| ["-s", *key])).collect()
}

#[test]
fn a_row_that_cannot_be_is_refused_by_key() {
    let folder = empty();
    let refused = |keys: &[&str]| refused(folder.path(), &with(&["run"], keys));
    let error = refused(&["spad.row_outputs=15"]);
    assert!(
        error.contains(
            "spad.row_outputs = 15: expected 0, or 16 or more, so that output 15 is in the row"
        ),
        "{error}"
    );
    let error = refused(&["spad.row_outputs=20", "spad.on_tdc=21"]);
    assert!(error.contains("spad.row_outputs = 20: expected 0, or 21 or more"), "{error}");
    let error = refused(&["spad.row_outputs=41"]);
    assert!(error.contains("spad.row_outputs = 41: expected 0, or 40 at most"), "{error}");
    assert!(refused(&["spad.row_outputs=65"]).contains("spad.row_outputs = 65: expected"));
    assert!(refused(&["spad.row_outputs=-1"]).contains("spad.row_outputs"));
    assert!(refused(&["spad.row_outputs=16.5"]).contains("spad.row_outputs"));
    let error = refused(&["spad.row_outputs=30", "stimulus.photons=photons.csv"]);
    assert!(error.contains("spad.row_outputs = 30: expected 0: the photons of a list"), "{error}");
    assert!(refused(&["spad.pulse_ns=-1"]).contains("spad.pulse_ns = -1"));
    assert!(refused(&["spad.pulse_ns=nan"]).contains("spad.pulse_ns"));
    assert!(refused(&["spad.pulse_gap_ns=1e6"]).contains("spad.pulse_gap_ns = 1000000"));
}

fn write(folder: &Path, rows: &str) {
    fs::write(folder.join("dark.csv"), format!("row,output,rate_hz\n{rows}")).unwrap();
}

#[test]
fn a_file_of_dark_rates_is_found_beside_the_scenario_and_its_faults_are_named() {
    let folder = empty();
    let here = folder.path();
    fs::create_dir(here.join("array")).unwrap();
    write(&here.join("array"), "0,15,300\n0,16,50\n1,15,9e5\n");
    fs::write(here.join("array/a.toml"), "[spad]\non_tdc = 3\ndark_file = \"dark.csv\"\n").unwrap();
    let dark = |args: &[&str]| json(here, args)["dark_rate_hz"].as_f64().unwrap();
    assert_eq!(dark(&["budget", "array/a.toml", "--json"]), 450.0);
    assert_eq!(dark(&["budget", "array/a.toml", "--json", "-s", "spad.temperature_c=28"]), 900.0);
    let spad = json(here, &["spad", "array/a.toml", "--counts", "5000", "--json"]);
    assert_eq!(spad["expected_dark_rate_hz"], 300.0);
    let [value, se] = ["value", "se"].map(|key| spad["dark_rate_hz"][key].as_f64().unwrap());
    assert!((value - 300.0).abs() < 4.0 * se, "{value} {se}");

    let refused = |keys: &[&str]| refused(here, &with(&["run"], keys));
    let file = "spad.dark_file=dark.csv";
    assert!(refused(&[file]).contains("dark.csv: cannot read"));
    write(here, "0,15,300\n0,30,1\n");
    let error = refused(&[file]);
    assert!(error.contains("dark.csv:3:3: output = 30: expected 0 to 29"), "{error}");
    write(here, "0,15,300\n0,15,300\n");
    assert!(refused(&[file]).contains("dark.csv:3:3: output = 15: expected each output once"));
    write(here, "0,15,x\n");
    assert!(refused(&[file]).contains("dark.csv:2:6: rate_hz = x: expected a rate from 0 to 1e9"));
    write(here, "0,15,3\n");
    let error = refused(&[file, "spad.dark_spread=0.5"]);
    assert!(error.contains("spad.dark_spread = 0.5: expected 0: spad.dark_file says"), "{error}");
}

const DRAWN: [&str; 4] = ["run", "--fidelity", "histogram", "--json"];

#[test]
fn a_frame_is_drawn_as_a_whole_where_the_row_changes_nothing_and_refused_elsewhere() {
    let folder = empty();
    let drawn = |keys: &[&str]| json(folder.path(), &with(&DRAWN, keys))["frames"].clone();
    assert_eq!(drawn(&["spad.row_outputs=30"]), drawn(&[]));
    let refused = |keys: &[&str]| refused(folder.path(), &with(&DRAWN, keys));
    let error = refused(&["spad.row_outputs=30", "spad.crosstalk_probability=0.1"]);
    assert!(
        error.contains("spad.crosstalk_probability = 0.1: ") && error.contains("spad.row_outputs"),
        "{error}"
    );
    assert!(refused(&["spad.pulse_ns=10"]).contains("spad.pulse_ns = 10: "));
    assert!(refused(&["spad.pulse_gap_ns=10"]).contains("spad.pulse_gap_ns = 10: "));
}

/// Few shots, at which the network is wrong.
const SHORT: &str = "firmware.shots_per_frame=3000";

/// Codes and keys of the notes of a run.
fn notes(keys: &[&str]) -> Vec<(String, String)> {
    let args = ["run", "--waves", "none", "--json"];
    let run: Value = json(empty().path(), &with(&args, keys));
    let text = |note: &Value, key: &str| note[key].as_str().unwrap_or_default().to_owned();
    let notes = run["notes"].as_array().unwrap().iter();
    notes.map(|note| (text(note, "code"), text(note, "key"))).collect()
}

#[test]
fn network_and_second_opinion_say_what_they_do_not_know() {
    let pair = |code: &str, key: &str| (code.to_owned(), key.to_owned());
    assert_eq!(notes(&[]), []);
    assert_eq!(notes(&["spad.row_outputs=30"]), [], "without crosstalk it decides nothing");
    let found = notes(&[SHORT, "spad.row_outputs=30", "spad.crosstalk_probability=0.1"]);
    assert!(found.contains(&pair("outside-training", "spad.row_outputs")), "{found:?}");
    assert!(found.contains(&pair("second-opinion", "spad.crosstalk_probability")), "{found:?}");
    let found = notes(&["spad.pulse_ns=30", "spad.pulse_gap_ns=5"]);
    for key in ["spad.pulse_ns", "spad.pulse_gap_ns"] {
        assert!(found.contains(&pair("outside-training", key)), "{found:?}");
    }
    assert!(found.contains(&pair("second-opinion", "spad.pulse_ns")), "{found:?}");
    let folder = empty();
    write(folder.path(), "");
    let file = format!("spad.dark_file={}", folder.path().join("dark.csv").display());
    assert_eq!(notes(&[&file]), [pair("outside-training", "spad.dark_file")]);
    let said = |kind: &str, key: &str| {
        let args = ["run", "--waves", "none", "--estimator", kind, "-s", SHORT, "-s", key];
        let said = output(
            empty().path(),
            &with(&args, &["spad.row_outputs=30", "spad.crosstalk_probability=0.2"]),
        );
        String::from_utf8(said.stderr).unwrap()
    };
    assert!(said("likelihood", "spad.pulse_ns=20").contains("the TDC misses avalanches"));
    let found = said("matched", "seed=2");
    assert!(found.contains("SPADs that are not on the TDC set off those that are"), "{found}");
    assert!(said("centroid", "spad.pulse_ns=20").contains("the TDC misses avalanches"));
}

#[test]
fn the_firmware_s_likelihood_estimator_notes_what_its_model_does_not_have() {
    let here = empty();
    let gap = ["-s", "estimator.kind=likelihood", "-s", "spad.pulse_gap_ns=10"];
    let args = ["run", "--waves", "none", "--no-second-opinion", "--strict"];
    let error = refused(here.path(), &[&args[..], &gap].concat());
    assert!(error.contains("spad.pulse_gap_ns = 10: likelihood_estimator: "), "{error}");
}

#[test]
fn a_wide_pulse_ends_later_than_the_reset_and_a_narrow_one_is_lost() {
    let hits = |scene: &[&str], pulses: &[&str]| {
        let args = ["run", "--waves", "none", "--json", "--no-second-opinion"];
        let run = json(empty().path(), &with(&args, &[scene, pulses].concat()));
        run["frames"][0]["hits"].as_u64().unwrap() as f64
    };
    let dark = ["ambient.irradiance_w_m2_nm=0", "target.reflectance=0", "spad.dark_rate_hz=2e6"];
    let [all, wide] = [&[][..], &["spad.pulse_ns=9"]].map(|pulses| hits(&dark, pulses));
    assert!((wide / all - 1.0).abs() < 0.01, "none is lost: {wide} of {all}");
    let narrow = hits(&dark, &["spad.pulse_ns=1", "spad.pulse_gap_ns=3"]);
    let off = (narrow - wide / 8.0) / (wide / 8.0).sqrt();
    assert!(off.abs() < 4.0, "{narrow} of {wide}: a pulse of 1 ns is seen once in eight times");
    // Each shot has an avalanche, and a pulse that began in one shot ends in the next but one.
    let bright = ["ambient.irradiance_w_m2_nm=0.4", "target.reflectance=0.6"];
    let [all, long] = [&[][..], &["spad.pulse_ns=80"]].map(|pulses| hits(&bright, pulses));
    assert!((0.45..0.55).contains(&(long / all)), "{long} of {all}");
}
