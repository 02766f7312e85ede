//! Tests that settings without pairs are refused by name.

use crate::common::{self, empty, refused};

use super::PAIRS;

#[test]
fn what_makes_no_pairs_is_refused_by_name() {
    let folder = empty();
    for (more, expected) in [
        (
            &["-s", "firmware.shots_per_frame=30001"][..],
            "firmware.shots_per_frame = 30001: expected an even",
        ),
        (&["-s", "firmware.laser_en=false"], "firmware.laser_en = false: expected true"),
        (
            &["histogram_validation"],
            "stimulus.codes = ../codes/kc705.csv: expected light or photons",
        ),
        (&["estimator_validation"], "stimulus.histogram = ../histograms/kc705.csv: expected light"),
        (
            &["-s", "control=[{at_us=5,laser_en=true}]"],
            "control.0.laser_en = true: expected no change",
        ),
        (&["-s", "firmware.dark_frames=false"], "firmware.dark_frames = false: expected true"),
        (&["--frames", "18000000000000000000"], "--frames: 18000000000000000000: expected 12,"),
        (&["--fidelity", "histogram", "-s", "firmware.mode=1"], "firmware.mode = 1"),
        (&["-s", "firmware.dark_frames=maybe"], "expected true or false"),
    ] {
        let error = refused(folder.path(), &[&PAIRS[..], more].concat());
        assert!(error.contains(expected), "{error}");
    }
    for (more, expected) in [
        (
            ["-s", "firmware.shots_per_frame=301"],
            "subtraction: shots = 301: expected an even number",
        ),
        (["-s", "firmware.laser_en=false"], "firmware.laser_en = false: expected true"),
        (["-s", "firmware.dark_frames=true"], "firmware.dark_frames = true: expected false"),
    ] {
        let args = ["evaluate", "--estimator", "subtraction", "--rows", "51", "--check", "0"];
        let error = refused(folder.path(), &[&args, &more[..]].concat());
        assert!(error.contains(expected), "{error}");
    }
    let error = refused(folder.path(), &["dataset", "-o", "d", "-s", "firmware.dark_frames=true"]);
    assert!(error.contains("firmware.dark_frames = true"), "{error}");
    assert!(common::files(folder.path()).is_empty(), "nothing is left behind");
}
