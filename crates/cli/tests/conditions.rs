//! A chain that changes within a run, from the command line.

use std::fs;

use serde_json::Value;

use crate::common::{empty, json, refused, stdout};

const SHORT: [&str; 7] =
    ["run", "--waves", "none", "--json", "-s", "firmware.shots_per_frame=2000", "-s"];

fn codes(report: &Value) -> Vec<(String, String)> {
    let text = |note: &Value, key: &str| note[key].as_str().unwrap().to_owned();
    let notes = report["notes"].as_array().unwrap().iter();
    notes.map(|note| (text(note, "code"), text(note, "key"))).collect()
}

fn has(report: &Value, code: &str, key: &str) -> bool {
    codes(report).contains(&(code.to_owned(), key.to_owned()))
}

#[test]
fn a_die_that_heats_up_in_a_run_is_noted_and_moves_the_depth() {
    let folder = empty();
    let rows = "time_s,temperature_c,supply_mv\n1.2e-4,25,0\n3e-4,65,0\n";
    fs::write(folder.path().join("heat.csv"), rows).unwrap();
    let scenario = "[target]\ndistance_m = 0.3\n[firmware]\nshots_per_frame = 2000\n\
                    [tdc]\nconditions = \"heat.csv\"\n[estimator]\nkind = \"centroid\"\n";
    fs::write(folder.path().join("mine.toml"), scenario).unwrap();
    let run = ["run", "mine.toml", "--waves", "none", "--json", "--frames", "5"];
    let report = json(folder.path(), &run);
    assert!(has(&report, "chain-drifted", "tdc.conditions"), "{report}");
    assert!(has(&report, "second-opinion", "tdc.conditions"), "{report}");
    let note = report["notes"].to_string();
    assert!(note.contains("off by -307.7 to +0.0 ps since it was calibrated"), "{note}");
    let depth = |k: usize| report["frames"][k]["depth_m"].as_f64().unwrap();
    // An age of 6 ns reads as 0.23 ns less.
    let moved = depth(4) - depth(0);
    assert!((moved - 0.0346).abs() < 0.006, "{moved}: {} {}", depth(0), depth(4));
    assert_eq!(report, json(folder.path(), &run), "the same again");
    // The network was trained for a chain that stands still.
    let network = json(folder.path(), &[&run[..], &["-s", "estimator.kind=network"]].concat());
    assert!(has(&network, "chain-drifted", "tdc.conditions"), "{network}");
}

#[test]
fn conditions_that_are_none_are_refused_by_line_or_key() {
    let folder = empty();
    let error = |rows: &str, args: &[&str]| {
        let text = format!("time_s,temperature_c,supply_mv\n{rows}");
        fs::write(folder.path().join("c.csv"), text).unwrap();
        let given = [&SHORT[..], &["tdc.conditions=c.csv"], args].concat();
        refused(folder.path(), &given)
    };
    let changing = "0,25,0\n1e-3,30,0\n";
    for (rows, args, words) in [
        ("0,25,0\n1e-3,86,0\n", &[][..], "c.csv:3:6: temperature_c = 86: expected a temperature"),
        ("0,25,0\n0,30,0\n", &[], "c.csv:3:1: time_s = 0: expected a time after"),
        ("0,25\n", &[], "c.csv:2"),
        ("", &[], "c.csv: expected one row"),
        ("0,25,0\n20000,30,0\n", &[], "c.csv: time_s = 20000: expected times of a run, 10000 s"),
        (
            changing,
            &["-s", "tdc.temperature_c=30"],
            "tdc.temperature_c = 30: expected 25: tdc.conditions",
        ),
        (changing, &["-s", "tdc.supply_mv=1"], "tdc.supply_mv = 1: expected 0: tdc.conditions"),
        (
            changing,
            &["--fidelity", "histogram"],
            "tdc.conditions = c.csv: expected none for --fidelity histogram: the delays of the chain",
        ),
        (
            "0,25,0\n1e-3,0,30\n",
            &["-s", "tdc.profile=ideal", "-s", "pll.output_divide=10"],
            "tdc.conditions = ",
        ),
    ] {
        let error = error(rows, args);
        assert!(error.contains(words), "{rows:?} {args:?}: {error}");
    }
    let given = [&SHORT[..], &["tdc.conditions=none.csv"]].concat();
    assert!(refused(folder.path(), &given).contains("none.csv"));
    for verb in [&["tdc"][..], &["verify", "--top"], &["dataset", "-o", "d.npz"], &["evaluate"]] {
        fs::write(
            folder.path().join("c.csv"),
            format!("time_s,temperature_c,supply_mv\n{changing}"),
        )
        .unwrap();
        let error = refused(folder.path(), &[verb, &["-s", "tdc.conditions=c.csv"]].concat());
        assert!(error.contains("tdc.conditions = c.csv: "), "{verb:?}: {error}");
    }
}

#[test]
fn a_set_up_window_is_refused_where_it_holds_more_taps_than_can_be_shown_and_where_nothing_draws_it()
 {
    let folder = empty();
    let with = |args: &[&str], keys: &[&str]| {
        let keys = keys.iter().flat_map(|key| ["-s", *key]);
        let all: Vec<_> = args.iter().copied().chain(keys).collect();
        refused(folder.path(), &all)
    };
    let error = with(&["run"], &["tdc.profile=kintex7", "tdc.setup_window_ps=20"]);
    let words = "tdc.setup_window_ps = 20: expected less than 19.679 ps: no more than 4 taps";
    assert!(error.contains(words), "{error}");
    assert!(with(&["run"], &["tdc.setup_window_ps=-1"]).contains("tdc.setup_window_ps = -1"));
    assert!(with(&["run"], &["tdc.setup_window_ps=46"]).contains("expected less than 46 ps"));
    for verb in [
        &["run", "--fidelity", "histogram"][..],
        &["verify", "--top"],
        &["vectors", "tof_top", "-o", "v"],
        &["evaluate"],
        &["budget", "--errors"],
        &["tdc", "drift", "--points", "2"],
    ] {
        let error = with(verb, &["tdc.setup_window_ps=5"]);
        assert!(error.contains("tdc.setup_window_ps = 5: "), "{verb:?}: {error}");
    }
    let given = [&SHORT[..], &["tdc.setup_window_ps=5"]].concat();
    let report = json(folder.path(), &given);
    assert!(has(&report, "outside-training", "tdc.setup_window_ps"), "{report}");
    assert!(has(&report, "second-opinion", "tdc.setup_window_ps"), "{report}");
    for (estimator, is_told) in [("likelihood", true), ("matched", true), ("centroid", false)] {
        let report = json(folder.path(), &[&given[..], &["--estimator", estimator]].concat());
        let key = "tdc.setup_window_ps";
        assert_eq!(has(&report, "estimator-outside-model", key), is_told, "{estimator}: {report}");
    }
    let text = stdout(folder.path(), &["tdc", "-s", "tdc.setup_window_ps=5", "--hits", "20000"]);
    assert!(text.contains("sample within 5 ps about\nthe edge (tdc.setup_window_ps)"), "{text}");
}

#[test]
fn a_ring_that_keeps_step_with_the_clock_is_noted() {
    let folder = empty();
    let noted = |ring: &str| {
        let keys = ["tdc.recalibrate_frames=1", "tdc.calibration_hits_log2=10", ring];
        let keys = keys.iter().flat_map(|key| ["-s", *key]);
        let args: Vec<_> = SHORT[..6].iter().copied().chain(keys).collect();
        json(folder.path(), &args)
    };
    assert!(!has(&noted("tdc.ring_ns=61.8"), "ring-in-step", "tdc.ring_ns"));
    let report = noted("tdc.ring_ns=64");
    assert!(has(&report, "ring-in-step", "tdc.ring_ns"), "{report}");
    let note = report["notes"].to_string();
    // 1,024 rises of 5 ps twice: a walk of 226 ps to either side.
    assert!(
        note.contains("to 7547 ps in a row of ages no hit") && note.contains("such as 68.944"),
        "{note}"
    );
}
