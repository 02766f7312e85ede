//! Tests of the second opinion of `run`.

use serde_json::Value;

use crate::common::{empty, json, output, stdout};

fn run(set: &[&str]) -> Value {
    let args = ["run", "--fidelity", "histogram", "--json"];
    json(empty().path(), &[&args[..], set].concat())
}

fn notes(run: &Value) -> Vec<&str> {
    let notes = run["notes"].as_array().unwrap().iter();
    notes.map(|note| note["code"].as_str().unwrap()).collect()
}

#[test]
fn a_frame_has_a_second_opinion_of_its_own_accuracy() {
    let found = run(&[]);
    let second = &found["frames"][0]["second_opinion"];
    assert_eq!(second["estimator"], "likelihood_estimator");
    let (depth_m, sigma_m) = (second["depth_m"].as_f64().unwrap(), second["sigma_m"].as_f64());
    assert!((depth_m - 0.5).abs() < 6.0 * sigma_m.unwrap() && sigma_m.unwrap() < 1e-3, "{second}");
    let raw = u64::from_str_radix(second["depth_raw"].as_str().unwrap(), 16).unwrap();
    assert_eq!(raw as f64 / (1u64 << 29) as f64, depth_m);
    assert_eq!(second["status"], serde_json::json!([]));
    assert!((10.0..200.0).contains(&second["chi_square"].as_f64().unwrap()), "{second}");
    assert!(notes(&found).is_empty() && found.get("second_opinion").is_none());
    // The estimator that is asked for by name sees the same.
    let asked = run(&["--estimator", "likelihood_estimator"]);
    assert_eq!(asked["frames"][0]["estimates"][0]["depth_m"], second["depth_m"]);
}

#[test]
fn every_estimate_has_the_same_members() {
    let members = ["estimator", "depth_m", "sigma_m", "valid", "status"];
    let of = |estimate: &Value| members.map(|member| estimate[member].clone());
    let set = ["-s", "estimator.kind=likelihood", "--estimator", "network,likelihood_estimator"];
    let found = run(&set);
    let (frame, estimates) = (&found["frames"][0], &found["frames"][0]["estimates"]);
    assert_eq!(of(frame), of(&frame["second_opinion"]));
    assert_eq!(of(frame), of(&estimates[1]));
    assert!(frame["sigma_m"].as_f64().unwrap() > 0.0 && frame["valid"] == true);
    assert_eq!(frame["estimator"], "likelihood_estimator");
    let network = of(&estimates[0]);
    assert_eq!((&network[0], &network[2]), (&"network".into(), &Value::Null));
    assert_eq!((&network[3], &network[4]), (&true.into(), &Value::Array(vec![])));
    let dark = run(&[&set[..], &["-s", "firmware.laser_en=false"]].concat());
    let frame = &dark["frames"][0];
    assert_eq!((&frame["valid"], &frame["status"][0]), (&false.into(), &"no echo".into()));
    let (of_frame, mut of_estimate) = (of(frame), of(&frame["estimates"][1]));
    assert!(of_estimate[1].is_null() && of_estimate[2].is_null());
    (of_estimate[1], of_estimate[2]) = (of_frame[1].clone(), of_frame[2].clone());
    assert_eq!(of_frame, of_estimate);
}

#[test]
fn a_network_out_of_its_depth_disagrees_with_it() {
    let far = ["-s", "target.distance_m=0.8"];
    let found = run(&[&far[..], &["--frames", "100"]].concat());
    assert_eq!(notes(&found), ["outside-training", "second-opinion"]);
    let all = &found["second_opinion"];
    assert_eq!((&all["frames"], &all["unbelieved"]), (&100.into(), &0.into()));
    assert!(all["parted"].as_u64().unwrap() > 90, "{all}");
    assert!(all["mean_error_m"].as_f64().unwrap().abs() < 5e-4, "{all}");
    let of_three = |threads| {
        let args = ["run", "--waves", "none", "--frames", "3", "--threads", threads];
        output(empty().path(), &[&args[..], &far].concat())
    };
    let one = of_three("1");
    let said = String::from_utf8(one.stderr.clone()).unwrap();
    assert!(
        said.contains("note: estimator.kind = network: it disagrees with likelihood_estimator in "),
        "{said}"
    );
    assert!(said.contains(" in 3 of 3 frames (most in frame "), "{said}");
    assert_eq!(of_three("2").stderr, one.stderr);
    let table = String::from_utf8(one.stdout).unwrap();
    assert!(table.contains("3 of 3 depths disagree with it; it rejected 0 frames"), "{table}");
    let table = stdout(empty().path(), &[&["run", "--waves", "none"], &far[..]].concat());
    assert!(
        table.contains("second opinion  0.79") || table.contains("second opinion  0.80"),
        "{table}"
    );
}

#[test]
fn a_histogram_without_an_echo_is_said_to_have_none() {
    let found = run(&["-s", "target.reflectance=0.00003"]);
    let status = found["frames"][0]["second_opinion"]["status"].to_string();
    assert!(status.contains("no echo"), "{status}");
    assert!(notes(&found).contains(&"second-opinion"), "{:?}", found["notes"]);
}

#[test]
fn where_there_is_none_a_note_says_why_and_strict_does_not_mind() {
    let args = ["run", "--waves", "none", "--json"];
    let with = |more: &[&str]| json(empty().path(), &[&args[..], more].concat());
    let found = with(&["-s", "firmware.mode=1"]);
    assert!(found["frames"][0]["second_opinion"].is_null());
    assert_eq!(notes(&found), ["outside-training", "second-opinion"]);
    // The centroid has no training that a range gate could be outside of.
    let gate = ["estimator.kind=centroid", "tdc.first_bin_ps=1000"];
    let own = ["estimator.centroid_offset_m=0.1498962", "target.distance_m=0.3"];
    let set = gate.iter().chain(&own).flat_map(|set| ["-s", set]);
    let faint = ["-s", "spad.pdp=0.0005", "-s", "ambient.irradiance_w_m2_nm=0", "--strict"];
    let found = with(&set.chain(faint).collect::<Vec<_>>());
    assert_eq!(notes(&found), ["second-opinion"]);
    let codes = json(empty().path(), &["run", "histogram_validation", "--waves", "none", "--json"]);
    assert_eq!(notes(&codes), ["no-light"]);
    assert!(codes["frames"][0]["second_opinion"].is_null());
    let without = with(&["-s", "target.distance_m=0.8", "--no-second-opinion"]);
    assert_eq!(notes(&without), ["outside-training"]);
    assert!(without["frames"][0]["second_opinion"].is_null());
}

#[test]
fn of_a_pair_the_lit_frame_has_one() {
    let found = run(&["--estimator", "subtraction", "--frames", "2"]);
    let frames = found["frames"].as_array().unwrap();
    assert!(frames.iter().step_by(2).all(|frame| frame["second_opinion"].is_null()));
    assert!(frames.iter().skip(1).step_by(2).all(|frame| frame["second_opinion"].is_object()));
}
