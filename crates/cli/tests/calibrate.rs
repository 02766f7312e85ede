//! `tofsim calibrate pulse`: from histograms to keys, a file and a picture.

mod glass;

use std::fs;
use std::path::Path;

use crate::common::{empty, json, refused, stdout};

/// A data set of a pulse, as `dataset` draws it.
fn drawn(folder: &Path, set: &[&str]) {
    let grid = ["target.distance_m=0.15..0.6:0.05", "target.reflectance=0.1,0.3,0.5"];
    let mut args = vec!["dataset", "--rows", "30", "--format", "npy", "-o", "."];
    grid.iter().for_each(|grid| args.extend(["--grid", grid]));
    set.iter().for_each(|set| args.extend(["-s", set]));
    stdout(folder, &args);
}

const PULSE: [&str; 3] = ["calibrate", "pulse", "histograms.npy"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&PULSE, more].concat()
}

#[test]
fn the_width_of_the_scenarios_own_pulse_is_found() {
    let folder = empty();
    drawn(folder.path(), &["laser.pulse_sigma_ps=150"]);
    let found = json(folder.path(), &with(&["--json"]));
    assert_eq!(found["taken"], "gaussian");
    assert_eq!((&found["histograms"], &found["without_echo"]), (&30.into(), &0.into()));
    let pulses = found["pulses"].as_array().unwrap();
    assert_eq!(pulses[0]["shape"], "scenario");
    let [sigma_ps, se_ps] = ["sigma_ps", "sigma_se_ps"].map(|key| pulses[1][key].as_f64().unwrap());
    assert!((sigma_ps - 150.0).abs() < 4.0 * se_ps && se_ps < 0.5, "{sigma_ps} {se_ps}");
    assert!(pulses[0]["chance"].as_f64().unwrap() < 1e-9, "137 ps is not what they are of");
    assert_eq!(found["keys"][1], "laser.pulse_tail_ps=0");
    let text = stdout(folder.path(), &with(&["-s", "laser.pulse_sigma_ps=150"]));
    assert!(text.starts_with("30 histograms of 30000 shots\n"), "{text}");
    assert!(text.contains("To take: gaussian") && text.contains("below "), "{text}");
}

#[test]
fn a_measured_pulse_is_one_that_a_scenario_can_have() {
    let folder = empty();
    let here = folder.path();
    drawn(here, &["laser.pulse_tail_ps=120"]);
    assert_eq!(json(here, &with(&["--json"]))["taken"], "tail");
    stdout(here, &with(&["--shape", "samples", "-o", "out"]));
    for name in ["out/pulse.csv", "out/pulse.svg", "out/calibration.json"] {
        assert_eq!(stdout(here, &["rerun", name]), format!("{name}: the same\n"));
    }
    let again = json(here, &with(&["-s", "laser.pulse_file=out/pulse.csv", "--json"]));
    let own = &again["pulses"][0];
    assert!(own["chance"].as_f64().unwrap() > 1e-4, "{own}");
    assert!((own["deviation_ps"].as_f64().unwrap() - 182.1).abs() < 4.0, "{own}");
    let run = ["run", "--fidelity", "histogram", "-s", "laser.pulse_file=out/pulse.csv", "--json"];
    let frame = &json(here, &run)["frames"][0]["second_opinion"];
    assert!((frame["depth_m"].as_f64().unwrap() - 0.5).abs() < 0.003, "{frame}");
}

#[test]
fn what_tells_nothing_of_a_pulse_is_refused() {
    let folder = empty();
    let here = folder.path();
    drawn(here, &[]);
    let few = refused(here, &with(&["-s", "firmware.shots_per_frame=100"]));
    assert!(few.starts_with("tofsim: histograms.npy: histogram 0 = "), "{few}");
    assert!(few.contains("expected 100 hits or fewer"), "{few}");
    let rows: String = (0..256).map(|bin| format!("{bin},0\n")).collect();
    fs::write(here.join("dark.csv"), format!("bin,count\n{rows}")).unwrap();
    let dark = refused(here, &["calibrate", "pulse", "dark.csv"]);
    assert!(dark.contains("none of 1: expected a histogram with an echo"), "{dark}");
    let mode = refused(here, &with(&["-s", "firmware.mode=1", "--shape", "samples"]));
    assert!(mode.contains("firmware.mode = 1"), "{mode}");
    let step = refused(here, &with(&["--shape", "samples", "--step-ps", "nan"]));
    assert!(step.contains("--step-ps"), "{step}");
    assert!(refused(here, &["calibrate", "pulse", "no.npy"]).contains("no.npy"));
}

#[test]
fn a_pulse_that_no_formula_has_is_measured_and_notes_say_what_is_not_described() {
    let folder = empty();
    let here = folder.path();
    let density = |t: f64| {
        (-0.5 * (t / 90.0).powi(2)).exp() + 0.3 * (-0.5 * ((t - 400.0) / 90.0).powi(2)).exp()
    };
    let rows: String =
        (-40..100).map(|k| format!("{},{}\n", k * 10, density(f64::from(k) * 10.0))).collect();
    fs::write(here.join("humps.csv"), format!("time_ps,density\n{rows}")).unwrap();
    drawn(here, &["laser.pulse_file=humps.csv"]);
    let found = json(here, &with(&["--json"]));
    assert_eq!((&found["taken"], &found["notes"]), (&"samples".into(), &serde_json::json!([])));
    assert!(found["samples"].as_array().unwrap().len() > 50);
    let tail = json(here, &with(&["--shape", "tail", "--json"]));
    assert_eq!(tail["notes"][0]["code"], "doubtful-fit");
    assert!(refused(here, &with(&["--shape", "tail", "--strict"])).contains("doubtful-fit"));
}
