//! Light that leaves after the laser edge: what each estimator makes of it, and what a user is told.

use serde_json::Value;

use crate::common::{empty, json, refused, stdout};

/// A run of a frame with these keys, shot by shot or drawn at once.
fn run(set: &[&str], fidelity: &str) -> Value {
    let base = ["run", "--waves", "none", "--json", "--fidelity", fidelity];
    let set = set.iter().flat_map(|key| ["-s", key]);
    json(empty().path(), &base.into_iter().chain(set).collect::<Vec<_>>())
}

fn keys(found: &Value) -> Vec<String> {
    let notes = found["notes"].as_array().unwrap().iter();
    notes.map(|note| note["key"].as_str().unwrap().to_owned()).collect()
}

fn depth_m(found: &Value) -> f64 {
    found["frames"][0]["depth_m"].as_f64().unwrap()
}

#[test]
fn the_likelihood_estimator_knows_it_in_every_way_through_time() {
    let set = ["estimator.kind=likelihood", "laser.delay_ps=1500", "target.distance_m=0.45"];
    for fidelity in ["shot", "histogram"] {
        let found = run(&set, fidelity);
        assert_eq!(keys(&found), [""; 0], "{fidelity}");
        assert!((depth_m(&found) - 0.45).abs() < 3e-3, "{fidelity}: {}", depth_m(&found));
    }
}

#[test]
fn a_network_that_was_trained_without_it_says_so_and_the_second_opinion_is_right() {
    let found = run(&["laser.delay_ps=1000"], "histogram");
    assert!(keys(&found).contains(&"laser.delay_ps".to_owned()), "{:?}", keys(&found));
    let second_m = found["frames"][0]["second_opinion"]["depth_m"].as_f64().unwrap();
    assert!((second_m - 0.5).abs() < 3e-3, "{second_m}");
    // 1000 ps are 0.15 m, and the network was trained up to 0.6 m.
    assert!((depth_m(&found) - 0.5).abs() > 0.05, "{}", depth_m(&found));
}

#[test]
fn the_centroid_takes_it_out_by_its_offset() {
    let scene = [
        "estimator.kind=centroid",
        "target.distance_m=0.3",
        "spad.pdp=0.0005",
        "ambient.irradiance_w_m2_nm=0",
    ];
    let run = |more: &[&str]| run(&[&scene[..], more].concat(), "histogram");
    let late = "laser.delay_ps=2000";
    let told = run(&[late, "estimator.centroid_offset_m=-0.2997925"]);
    assert_eq!(keys(&told), [""; 0]);
    let at_once = run(&[]);
    assert!((depth_m(&told) - depth_m(&at_once)).abs() < 2e-3, "{}", depth_m(&told));
    let untold = run(&[late]);
    assert!(keys(&untold).contains(&"estimator.centroid_offset_m".to_owned()));
    assert!((depth_m(&untold) - depth_m(&at_once) - 0.2998).abs() < 2e-3, "{}", depth_m(&untold));
}

#[test]
fn a_budget_tells_flight_from_delay() {
    let folder = empty();
    let late = ["budget", "-s", "laser.delay_ps=1000"];
    let table = stdout(folder.path(), &late);
    assert!(table.contains("3335.6 ps of flight, 1000.0 ps after the laser edge"), "{table}");
    let found = json(folder.path(), &[&late[..], &["--json"]].concat());
    assert_eq!(
        (&found["time_of_flight_ps"], &found["laser_delay_ps"]),
        (&3335.641.into(), &1000.0.into())
    );
    let plain = stdout(folder.path(), &["budget"]);
    assert!(plain.contains("3335.6 ps of flight\n"), "{plain}");
}

#[test]
fn a_delay_that_no_laser_has_is_refused() {
    let folder = empty();
    for value in ["-1", "50001", "nan"] {
        let error = refused(folder.path(), &["run", "-s", &format!("laser.delay_ps={value}")]);
        assert!(error.contains("laser.delay_ps"), "{error}");
    }
}
