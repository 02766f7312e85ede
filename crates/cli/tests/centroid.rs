//! The centroid estimator in the firmware's socket, as a user sees it.

use serde_json::Value;

use tofsim::hierarchy::entries;

use crate::common::{empty, json, output, refused, setup, short_run, stdout};

/// The key that puts it there.
const KIND: &str = "estimator.kind=centroid";

/// One frame of `kc705` by that estimator, with other arguments.
fn frame(args: &[&str]) -> Value {
    let folder = empty();
    let run = [&["run", "-s", KIND, "--waves", "none", "--json"], args].concat();
    json(folder.path(), &run)["frames"][0].clone()
}

#[test]
fn a_frame_takes_308_cycles_of_the_estimator_and_ends_near_the_target() {
    let frame = frame(&[]);
    assert_eq!(frame["estimator_cycles"], 312);
    assert_eq!(frame["frame_cycles"], 30_000 * 6 + 256 + 1 + 16 + 1 + 312);
    let error_m = frame["depth_m"].as_f64().unwrap() - 0.5;
    assert!((-0.03..0.0).contains(&error_m), "{error_m}: pile-up makes it early");
}

#[test]
fn shots_drawn_one_by_one_give_the_frames_of_every_cycle() {
    let keys = ["--frames", "3", "--seed", "5"];
    assert_eq!(frame(&[&keys[..], &["--fidelity", "shot"]].concat()), frame(&keys));
    let drawn = frame(&["--fidelity", "histogram"]);
    assert_eq!(drawn["estimator_cycles"], 312);
    assert_eq!(drawn["frame_cycles"], frame(&[])["frame_cycles"]);
}

#[test]
fn in_the_socket_and_beside_it_it_says_the_same() {
    for keys in [
        &[][..],
        &["-s", "estimator.centroid_half_width=5", "-s", "estimator.centroid_background=false"],
        &["-s", "estimator.centroid_slope_m=0.0036", "-s", "estimator.centroid_offset_m=-0.25"],
    ] {
        let reading = |frame: &Value| frame["estimates"][0]["depth_m"].clone();
        let in_socket = frame(&[keys, &["--estimator", "centroid"]].concat());
        assert_eq!(reading(&in_socket), in_socket["depth_m"], "{keys:?}");
        let folder = empty();
        let beside = ["run", "--waves", "none", "--json", "--estimator", "centroid"];
        let beside = json(folder.path(), &[&beside, keys].concat())["frames"][0].clone();
        assert_eq!(reading(&beside), in_socket["depth_m"], "{keys:?}");
        assert_eq!(beside["estimator_cycles"], 267);
    }
}

#[test]
fn waveforms_have_the_estimator_in_use_and_not_the_other() {
    for (kind, used, depth, unused) in [
        ("network", "tof_top.depth_estimator", "depth_estimator.forward2.depth", "centroid_est"),
        ("centroid", "tof_top.centroid_estimator", "centroid_estimator.depth", "depth_est"),
    ] {
        let setup = setup("kc705", &[&format!("estimator.kind={kind}")]);
        let entries = entries(&setup.params);
        let id = |path: &str| entries.iter().find(|entry| entry.path() == path).unwrap().id;
        assert_eq!(id("tof_top.depth"), id(&format!("tof_top.{depth}")));
        assert_eq!(id("tof_top.algo_start"), id(&format!("{used}.algo_start")));
        assert!(entries.iter().all(|entry| !entry.scope.contains(unused)), "{kind}");
    }
}

#[test]
fn the_window_of_the_estimation_has_all_of_it() {
    let folder = empty();
    let args = short_run(&["-s", KIND, "--window", "estimation", "--signals", "hist_valid"]);
    stdout(folder.path(), &args);
    let text = std::fs::read_to_string(folder.path().join("waves/kc705.vcd")).unwrap();
    let times: Vec<u64> = text
        .lines()
        .filter_map(|line| line.strip_prefix('#'))
        .filter_map(|time| time.parse().ok())
        .collect();
    // Two cycles before algo_start, the start, 312 of the estimator, two after: after the x at #0.
    let span = times.last().unwrap() - times[1];
    assert!((8000 * 312..8000 * 322).contains(&span), "{span}");
}

#[test]
fn a_logic_analyser_captures_it_and_compare_knows_its_parameters() {
    let folder = empty();
    let folder = folder.path();
    let probes = [
        ("START", "frame_ctrl.algo_start", "hex"),
        ("ADDRESS", "centroid_estimator.read_addr", "unsigned"),
        ("DONE", "centroid_estimator.algo_done", "hex"),
        ("DEPTH", "centroid_estimator.depth", "signed"),
    ];
    let mut text = String::from(
        "scenario = \"estimator_validation\"\nframes = 3\nclock = \"clk_sys\"\ndepth = 1024\n\
         position = 16\ntrigger = \"START rising\"\n",
    );
    for (name, signal, radix) in probes {
        text +=
            &format!("[[probe]]\nname = \"{name}\"\nsignal = \"{signal}\"\nradix = \"{radix}\"\n");
    }
    std::fs::write(folder.join("c.toml"), text).unwrap();
    stdout(folder, &["ila", "capture", "--probes", "c.toml", "-s", KIND, "-o", "board"]);
    let beside = ["compare", "--scenario", "estimator_validation", "--frames", "3", "-s", KIND];
    for file in ["board/c.csv", "board/c.vcd", "board/c.ila"] {
        let map = ["--map", "board/c.map.toml", file];
        let text = stdout(folder, &[&beside[..], &map].concat());
        assert!(text.contains("compared  4 signals") && text.ends_with("same\n"), "{text}");
        let other = [&beside[..], &["-s", "estimator.centroid_offset_m=0.01"], &map].concat();
        let output = output(folder, &other);
        let text = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(text.contains("first     tof_top.centroid_estimator.depth"), "{text}");
    }
    let error = refused(folder, &["ila", "capture", "--probes", "fig_6_21", "-s", KIND, "-o", "b"]);
    assert!(error.contains("the scenario's design leaves this module out"), "{error}");
}

#[test]
fn bad_values_are_refused_with_field_value_and_what_was_expected() {
    for (key, value, expected) in [
        ("kind", "median", "expected one of `network`, `centroid`"),
        ("centroid_half_width", "0", "expected a whole number from 1 to 31 [bins]"),
        ("centroid_half_width", "32", "expected a whole number from 1 to 31 [bins]"),
        ("centroid_background", "7", "expected true or false"),
        ("centroid_slope_m", "0.01", "expected a number from 0.0001 to 0.0078 [m]"),
        ("centroid_offset_m", "-1", "expected a number from -0.99 to 0.99 [m]"),
    ] {
        let folder = empty();
        let key = format!("estimator.{key}");
        let error = refused(folder.path(), &["run", "-s", &format!("{key}={value}")]);
        assert!(error.contains(&key) && error.contains(value), "{error}");
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn evaluate_measures_it_and_cross_checks_it_in_the_firmware() {
    let folder = empty();
    let scenario = folder.path().join("own.toml");
    std::fs::write(&scenario, "[estimator]\nkind = \"centroid\"\n").unwrap();
    let args = ["evaluate", "--estimator", "centroid", "--rows", "306", "--check", "2", "--json"];
    let report = json(folder.path(), &[&args[..], &["--scenario", "own.toml"]].concat());
    assert_eq!(report["estimators"][0]["name"], "centroid");
    for check in report["cross_check"].as_array().unwrap() {
        assert_eq!(check["other_depths"], 0);
    }
}
