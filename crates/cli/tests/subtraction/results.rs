//! JSON, tables and files: which frame was dark, the signed difference, the depth.

use std::fs;

use serde_json::Value;

use tofsim::network::Histogram;
use tofsim_learn::estimation::subtraction::Subtraction;
use tofsim_learn::estimation::{Estimator, HistogramPair};

use crate::common::{self, empty, json, refused, setup, stdout};

use super::{PAIRS, counts, pairs};

fn histogram(frame: &Value) -> Histogram {
    let counts = counts(&frame["histogram"]);
    counts.iter().map(|&count| count as u32).collect()
}

#[test]
fn a_depth_comes_from_a_dark_and_a_lit_frame_at_every_fidelity() {
    let folder = empty();
    let setup = setup("kc705", &["firmware.dark_frames=true"]);
    let subtraction = Subtraction::of_bins(30_000, &setup.bins()).unwrap();
    for fidelity in ["cycle", "shot", "histogram"] {
        let run = pairs(folder.path(), &["--fidelity", fidelity, "--frames", "3"]);
        assert_eq!(run["schema"], "tofsim.run/1");
        assert!(run.get("depth").is_none(), "the words of dark frames are no depths");
        let frames = run["frames"].as_array().unwrap();
        assert_eq!(frames.len(), 6, "{fidelity}: --frames counts pairs");
        for (index, two) in frames.chunks(2).enumerate() {
            for (kind, frame) in two.iter().enumerate() {
                assert_eq!(frame["index"], 2 * index + kind);
                assert_eq!(frame["pair"], index);
                assert_eq!(frame["laser_en"], kind == 1);
                assert_eq!(
                    (&frame["shots"], &frame["frame_cycles"]),
                    (&15_000.into(), &90_541.into())
                );
                assert_eq!(frame["difference"].is_array(), kind == 1);
                assert_eq!(frame["estimates"].is_array(), kind == 1);
            }
            let pair = HistogramPair { dark: histogram(&two[0]), lit: histogram(&two[1]) };
            let difference = counts(&two[1]["difference"]);
            assert!(difference.iter().copied().eq(pair.difference().into_iter().map(i64::from)));
            assert!(difference.iter().any(|&hits| hits < 0), "signed");
            let depth_m = two[1]["estimates"][0]["depth_m"].as_f64().unwrap();
            assert_eq!(two[1]["estimates"][0]["estimator"], "subtraction");
            assert!((depth_m - subtraction.estimate_pair(&pair).unwrap()).abs() < 1e-12);
            assert!((depth_m - 0.5).abs() < 0.02, "{depth_m}");
        }
        assert_eq!((&run["pairs"]["count"], &run["pairs"]["failures"]), (&3.into(), &0.into()));
    }
}

#[test]
fn a_slower_answer_within_clear_changes_no_frame() {
    let folder = empty();
    for fidelity in ["cycle", "shot", "histogram"] {
        let with = |response_ns: &str| {
            let set = format!("firmware.response_ns={response_ns}");
            pairs(folder.path(), &["--fidelity", fidelity, "--frames", "2", "-s", &set])
        };
        let (quick, slow) = (with("1"), with("2000"));
        assert_eq!(quick["frames"], slow["frames"], "{fidelity}");
    }
    let error =
        refused(folder.path(), &[&PAIRS[..], &["-s", "firmware.response_ns=2001"]].concat());
    assert!(error.contains("firmware.response_ns = 2001"), "{error}");
}

#[test]
fn the_laser_answers_to_the_depth_of_whatever_is_in_the_socket() {
    let folder = empty();
    for fidelity in ["cycle", "shot", "histogram"] {
        let centroid = ["--fidelity", fidelity, "--frames", "2", "-s", "estimator.kind=centroid"];
        let run = pairs(folder.path(), &centroid);
        for (index, frame) in run["frames"].as_array().unwrap().iter().enumerate() {
            assert_eq!(frame["laser_en"], index % 2 == 1, "{fidelity}, frame {index}");
            assert_eq!(frame["estimator_cycles"], 312);
        }
        assert_eq!(run["pairs"]["count"], 2, "{fidelity}");
        let depth_m = run["pairs"]["mean_m"].as_f64().unwrap();
        assert!((depth_m - 0.5).abs() < 0.02, "{fidelity}: {depth_m}");
    }
}

#[test]
fn cycle_and_shot_print_the_same_whatever_the_threads() {
    let folder = empty();
    for keys in [
        ["firmware.laser_freq=3", "pll.jitter_rms_ps=0"],
        ["firmware.laser_freq=0", "pll.jitter_rms_ps=7.7"],
        ["firmware.mode=1", "pll.jitter_rms_ps=0"],
        ["firmware.laser_freq=1", "control=[{at_us=30,laser_freq=2}]"],
    ] {
        let print = |fidelity: &str, threads: &str| {
            let options = ["--frames", "4", "-s", "firmware.shots_per_frame=600", "-s", keys[0]];
            let how = ["-s", keys[1], "--fidelity", fidelity, "--threads", threads, "--json"];
            stdout(folder.path(), &[&PAIRS, &options[..], &how[..]].concat())
        };
        let cycle = print("cycle", "1");
        let named = |fidelity: &str| format!("\"fidelity\":\"{fidelity}\"");
        for threads in ["1", "2", "3"] {
            assert_eq!(print("cycle", threads), cycle, "{keys:?}, {threads} threads");
            let shot = print("shot", threads).replace(&named("shot"), &named("cycle"));
            let shot = shot.replace("--fidelity=shot", "--fidelity=cycle");
            assert_eq!(shot, cycle, "{keys:?}, {threads} threads");
        }
    }
    let drawn = |threads| {
        let how = ["--fidelity", "histogram", "--frames", "300", "--json", "--threads", threads];
        stdout(folder.path(), &[&PAIRS, &how[..]].concat())
    };
    assert_eq!(drawn("1"), drawn("3"));
}

#[test]
fn a_folder_of_results_is_the_same_whatever_the_threads() {
    let folder = empty();
    for frames in ["1", "3"] {
        let files = |threads: &str| {
            let options = ["--frames", frames, "--threads", threads, "-o", threads];
            stdout(folder.path(), &[&PAIRS, &options[..]].concat());
            let names = ["summary.json", "histogram.csv", "histogram.svg", "difference.csv"];
            assert_eq!(common::files(&folder.path().join(threads)).len(), names.len());
            names.map(|name| fs::read_to_string(folder.path().join(threads).join(name)).unwrap())
        };
        let [summary, shown, picture, difference] = files("1");
        assert_eq!(files("3"), [&summary, &shown, &picture, &difference].map(String::clone));
        let summary: Value = serde_json::from_str(&summary).unwrap();
        let frames = &summary["frames"];
        let rows = difference.lines().skip(2).map(|row| {
            let fields: Vec<i64> = row.split(',').map(|field| field.parse().unwrap()).collect();
            [fields[1], fields[2], fields[3]]
        });
        let expected = counts(&frames[0]["histogram"]).into_iter();
        let expected = expected.zip(counts(&frames[1]["histogram"]));
        let expected = expected.zip(counts(&frames[1]["difference"]));
        assert!(rows.eq(expected.map(|((dark, lit), hits)| [dark, lit, hits])));
        let lit =
            shown.lines().skip(2).map(|row| row.split_once(',').unwrap().1.parse::<i64>().unwrap());
        assert!(lit.eq(counts(&frames[1]["histogram"])), "the lit frame is the one shown");
        assert!(picture.contains("signal: "), "its hits by cause");
    }
}

#[test]
fn given_photons_are_paired_by_their_shots() {
    let folder = empty();
    let list = "shot,arrival_ps\n0,1012.5\n1,5012.5\n2,3012.5\n3,3012.5\n";
    fs::write(folder.path().join("photons.csv"), list).unwrap();
    fs::write(folder.path().join("list.toml"), "[stimulus]\nphotons = \"photons.csv\"\n").unwrap();
    let keys = ["list.toml", "-s", "firmware.shots_per_frame=4", "-s", "tdc.profile=ideal"];
    let run = pairs(folder.path(), &keys);
    let lit = &run["frames"][1];
    let difference = counts(&lit["difference"]);
    let taken: Vec<_> = difference.iter().enumerate().filter(|(_, hits)| **hits != 0).collect();
    assert_eq!(taken, [(40, &-1), (120, &2), (200, &-1)]);
    assert!(lit["right_of_echo"].is_null(), "no light was simulated");
    assert_eq!(run["pairs"]["right_of_echo"], Value::Null);
}

#[test]
fn the_table_has_both_frames_and_their_difference() {
    let folder = empty();
    let text = stdout(folder.path(), &PAIRS);
    for part in [
        "subtraction  ",
        "15,000 dark, 15,000 lit",
        "lit less dark",
        "right of the echo",
        "181,083 cycles",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let many = stdout(
        folder.path(),
        &[&PAIRS[..], &["--fidelity", "histogram", "--frames", "12"]].concat(),
    );
    assert!(many.contains("... 2 more") && many.contains("0 failures in 12 pairs"), "{many}");
    let alone = ["run", "--waves", "none", "-s", "firmware.dark_frames=true", "--json"];
    let run = json(folder.path(), &alone);
    assert!(
        run["frames"][1]["difference"].is_array() && run["frames"][1].get("estimates").is_none()
    );
    assert!(run["pairs"]["failures"].is_null());
}
