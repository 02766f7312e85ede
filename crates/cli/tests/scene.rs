//! Fog, other targets and meshes on the command line: figures, notes, and what is refused.

use std::fs;

use serde_json::Value;

use crate::common::{empty, json, refused, stdout};

fn set<'a>(verb: &'a [&'a str], keys: &'a [&'a str]) -> Vec<&'a str> {
    verb.iter().copied().chain(keys.iter().flat_map(|key| ["-s", key])).collect()
}

fn keys(found: &Value, code: &str) -> Vec<String> {
    let notes = found["notes"].as_array().unwrap().iter().filter(|note| note["code"] == code);
    notes.map(|note| note["key"].as_str().unwrap().to_owned()).collect()
}

/// A pyramid whose base faces the sensor.
const PYRAMID: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0 0 -1\n\
    f 1 2 3 4\nf 2 1 5\nf 3 2 5\nf 4 3 5\nf 1 4 5\n";

#[test]
fn a_budget_has_what_fog_and_patch_make_of_the_light_where_there_are_such() {
    let folder = empty();
    let table = |keys: &[&str]| stdout(folder.path(), &set(&["budget"], keys));
    let clear = table(&[]);
    for row in ["backscatter", "transmission", "airlight", "patch"] {
        assert!(!clear.contains(row), "{clear}");
    }
    let fog = table(&["atmosphere.visibility_m=10", "target.retro_side_m=0.02"]);
    for row in ["backscatter", "transmission", "airlight", "patch"] {
        assert!(fog.lines().any(|line| line.trim_start().starts_with(row)), "{row}: {fog}");
    }
    let of = |keys: &[&str]| json(folder.path(), &set(&["budget", "--json"], keys));
    assert!(of(&[])["backscatter_per_shot"].is_null());
    let found = of(&["atmosphere.visibility_m=10"]);
    let number = |key: &str| found[key].as_f64().unwrap();
    let expected = (-2.0 * 50f64.ln() / 10.0 * 0.5).exp();
    assert!((number("transmission") / expected - 1.0).abs() < 0.01);
    assert!(number("backscatter_per_shot") > 0.0 && number("airlight_rate_hz") > 0.0);
    assert_eq!(number("retro_per_shot"), 0.0);
}

#[test]
fn who_takes_light_for_one_echo_says_so() {
    let folder = empty();
    let run = |verb: &[&str], keys: &[&str]| {
        let base = ["run", "--json", "--waves", "none", "--fidelity", "histogram"];
        json(folder.path(), &set(&[&base, verb].concat(), keys))
    };
    let fog = ["atmosphere.visibility_m=10"];
    let found = run(&[], &fog);
    assert_eq!(keys(&found, "outside-training"), fog.map(|key| key.split('=').next().unwrap()));
    assert_eq!(keys(&found, "second-opinion").len(), 1);
    assert!(found["frames"][0]["second_opinion"].is_null());
    for estimator in ["likelihood", "two-echoes", "matched", "likelihood_estimator"] {
        let found = run(&["--estimator", estimator], &["target.shape=sphere"]);
        assert_eq!(keys(&found, "estimator-outside-model"), ["target.shape"], "{estimator}");
    }
    let found = run(&[], &["estimator.kind=likelihood", "target.tilt_deg=30"]);
    assert_eq!(keys(&found, "estimator-outside-model"), ["target.tilt_deg"]);
    let errors = ["budget", "--errors", "--json", "--frames", "8", "--estimator", "likelihood"];
    let found = json(folder.path(), &set(&errors, &fog));
    assert_eq!(keys(&found, "estimator-outside-model"), ["atmosphere.visibility_m"]);
    let point = found["points"][0].as_object().unwrap();
    assert!(point["cramer_rao_two_sd_mm"].is_null(), "there is a bound for one echo only");
}

#[test]
fn a_mesh_is_read_from_beside_the_scenario_and_is_part_of_its_hash() {
    let folder = empty();
    let path = folder.path();
    fs::write(path.join("pyramid.obj"), PYRAMID).unwrap();
    let scene = "[target]\nshape = \"mesh\"\nmesh_file = \"pyramid.obj\"\nmesh_unit_m = 0.05\n";
    fs::write(path.join("scene.toml"), scene).unwrap();
    let found = json(path, &["budget", "scene.toml", "--json"]);
    let plate = ["target.length_m=0.1", "target.width_m=0.1"];
    let plate = json(path, &set(&["budget", "--json"], &plate));
    let signal = |found: &Value| found["signal_per_shot"].as_f64().unwrap();
    assert!((signal(&found) / signal(&plate) - 1.0).abs() < 1e-3, "{found}");
    fs::write(path.join("pyramid.obj"), PYRAMID.replace("0 0 -1", "0 0 -2")).unwrap();
    let deeper = json(path, &["budget", "scene.toml", "--json"]);
    assert_eq!(signal(&deeper), signal(&found), "what is behind is not seen");
    assert_ne!(deeper["hash"], found["hash"]);
    let run = ["run", "scene.toml", "--json", "--waves", "none", "--fidelity", "shot"];
    assert_eq!(keys(&json(path, &run), "outside-training"), ["target.shape"]);
}

#[test]
fn a_mesh_that_is_none_is_refused_by_its_line_with_what_was_expected() {
    let folder = empty();
    let path = folder.path();
    let error = |text: &str| {
        fs::write(path.join("m.obj"), text).unwrap();
        refused(path, &set(&["budget"], &["target.shape=mesh", "target.mesh_file=m.obj"]))
    };
    let nan = error(&PYRAMID.replace("v 1 1 0", "v 1 NaN 0"));
    assert!(nan.contains("m.obj:3:5: y = NaN: expected a finite number"), "{nan}");
    let open = error(&PYRAMID.replace("f 1 4 5\n", ""));
    assert!(open.contains("m.obj:6:1: ") && open.contains("expected a closed mesh"), "{open}");
    let swapped = "f 1 4 3 2\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
    let inside_out = error(&(PYRAMID[..PYRAMID.find('f').unwrap()].to_owned() + swapped));
    assert!(inside_out.contains("m.obj: volume = -8: expected more than 0"), "{inside_out}");
    assert!(inside_out.contains("inside out"), "{inside_out}");
    let missing =
        refused(path, &set(&["budget"], &["target.shape=mesh", "target.mesh_file=n.stl"]));
    assert!(missing.contains("n.stl"), "{missing}");
}
