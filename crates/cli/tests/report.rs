//! `tofsim report`, as its user meets it.

use std::fs;

use serde_json::Value;

use crate::common::{empty, files, refused, stdout};
use crate::reproduce::page::is_whole;

/// The page and the object of a report.
fn report(args: &[&str]) -> (String, Value) {
    let folder = empty();
    stdout(folder.path(), &[&["report", "-o", "out", "--quick", "-q"], args].concat());
    let read = |name: &str| fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    (read("report.html"), serde_json::from_str(&read("report.json")).unwrap())
}

#[test]
fn the_page_of_a_scenario_is_whole_and_shows_what_was_measured() {
    let (page, object) = report(&["-s", "target.distance_m=0.3"]);
    assert_eq!(is_whole(&page), 8);
    assert_eq!(object["schema"], "tofsim.report/1");
    assert_eq!(object["set"], serde_json::json!(["target.distance_m=0.3"]));
    for key in ["hash", "notes", "seed", "budget", "run", "tdc", "evaluation"] {
        assert!(!object[key].is_null(), "{key}");
    }
    let frame = &object["run"]["frames"][0];
    let all = &object["evaluation"]["estimators"][0]["all"];
    for text in [
        format!("{:.6} m", frame["depth_m"].as_f64().unwrap()),
        format!("{:.2} mm", all["two_sd_mm"].as_f64().unwrap()),
        format!("{:.4}", object["budget"]["signal_per_shot"].as_f64().unwrap()),
        format!("{:.3}", object["tdc"]["lsb_ps"].as_f64().unwrap()),
        frame["frame_cycles"].to_string(),
        "--verify runs it".to_owned(),
    ] {
        assert!(page.contains(&text), "{text}");
    }
}

#[test]
fn what_a_scenario_does_not_allow_is_left_out_with_the_reason() {
    let (page, object) = report(&["estimator_validation"]);
    assert!(is_whole(&page) < 8);
    for reason in ["no shot begins in the run", "no light is simulated"] {
        assert!(page.contains(reason), "{reason}");
    }
    assert!(object["evaluation"].is_null() && !object["run"].is_null());
}

#[test]
fn the_same_scenario_gives_the_same_bytes_on_any_number_of_threads() {
    let of = |threads: &str| report(&["far", "--threads", threads]).1["evaluation"].clone();
    assert_eq!(of("1"), of("3"));
}

#[test]
fn a_folder_receives_page_object_and_waveform_or_nothing() {
    let folder = empty();
    let path = folder.path();
    stdout(path, &["report", "near", "-o", "out", "--quick", "-q"]);
    assert_eq!(files(&path.join("out")), ["report.html", "report.json", "waveform.json"]);
    let wave: Value =
        serde_json::from_slice(&fs::read(path.join("out/waveform.json")).unwrap()).unwrap();
    let names: Vec<_> = (wave["signal"].as_array().unwrap().iter())
        .map(|signal| signal["name"].as_str().unwrap())
        .collect();
    assert!(names.contains(&"tdc_stop") && names.contains(&"tdc_code [ps]"), "{names:?}");
    let error = refused(path, &["report", "nar", "-o", "other"]);
    assert!(error.contains("near"), "{error}");
    assert!(!path.join("other").exists());
}
