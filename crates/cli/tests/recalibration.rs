//! A firmware that calibrates its TDC, from the command line.

use crate::common::{empty, json, output, refused};

const RUN: [&str; 9] = [
    "run",
    "--waves",
    "none",
    "--json",
    "-s",
    "tdc.profile=kintex7",
    "-s",
    "firmware.shots_per_frame=3000",
    "--no-second-opinion",
];

fn with<'a>(args: &[&'a str], keys: &[&'a str]) -> Vec<&'a str> {
    args.iter().copied().chain(keys.iter().flat_map(|key| ["-s", *key])).collect()
}

#[test]
fn frames_wait_for_a_calibration_and_their_codes_are_by_it() {
    let folder = empty();
    let frames = |keys: &[&str]| {
        let args = with(&[&RUN[..], &["--frames", "5"]].concat(), keys);
        let report = json(folder.path(), &args);
        report["frames"].as_array().unwrap().clone()
    };
    let own = frames(&[]);
    let calibrated = frames(&["tdc.recalibrate_frames=2", "tdc.calibration_hits_log2=14"]);
    let cycles = |frame: &serde_json::Value| frame["frame_cycles"].as_u64().unwrap();
    let begun: Vec<_> = calibrated.iter().map(|frame| cycles(frame) > cycles(&own[0])).collect();
    assert_eq!(begun, [true, false, true, false, true], "before every second one");
    // 2^14 periods of 61.8 ns are 126,566 cycles.
    assert!(cycles(&calibrated[0]) - cycles(&own[0]) > 126_000);
    for (frame, usual) in calibrated.iter().zip(&own) {
        let hits = |frame: &serde_json::Value| frame["hits"].as_u64().unwrap();
        assert!(hits(frame).abs_diff(hits(usual)) < 20, "{frame} {usual}");
        assert_ne!(frame["histogram"], usual["histogram"]);
    }
}

#[test]
fn what_cannot_be_calibrated_is_refused_by_key() {
    let folder = empty();
    let refused = |keys: &[&str]| {
        refused(folder.path(), &with(&with(&RUN, &["tdc.recalibrate_frames=1"]), keys))
    };
    let words = "tdc.calibration: expected nothing: the firmware calibrates itself";
    let error = refused(&["tdc.calibration=uniform"]);
    assert!(error.contains(words), "{error}");
    assert!(refused(&["tdc.calibrated_at_c=30"]).contains("tdc.calibrated_at_c: expected nothing"));
    let error = refused(&["tdc.ring_ns=20"]);
    assert!(error.contains("tdc.ring_ns = 20: expected more than"), "{error}");
    let error = refused(&["tdc.calibration_hits_log2=21"]);
    assert!(error.contains("tdc.calibration_hits_log2 = 21"), "{error}");
    let error = refused(&["tdc.recalibrate_frames=70000"]);
    assert!(error.contains("tdc.recalibrate_frames = 70000"), "{error}");
    let at_once =
        with(&["run", "--fidelity", "histogram", "--json"], &["tdc.recalibrate_frames=1"]);
    let error = crate::common::refused(folder.path(), &at_once);
    assert!(error.contains("tdc.recalibrate_frames = 1"), "{error}");
}

#[test]
fn a_network_that_was_trained_without_says_so() {
    let folder = empty();
    let keys = ["tdc.recalibrate_frames=1", "tdc.calibration_hits_log2=10"];
    let said = output(folder.path(), &with(&RUN, &keys));
    let said = String::from_utf8_lossy(&said.stderr).into_owned();
    assert!(said.contains("tdc.recalibrate_frames = 1"), "{said}");
}
