//! `estimate --explain` of the likelihood estimator.

use crate::common::{empty, json, refused, stdout};

const HISTOGRAM: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../stimuli/histograms/kc705.csv");
const LIKELIHOOD: [&str; 4] = ["estimate", HISTOGRAM, "--estimator", "likelihood_estimator"];

#[test]
fn an_explanation_ends_with_the_depth_that_is_printed() {
    let folder = empty();
    let report = json(folder.path(), &[&LIKELIHOOD[..], &["--explain", "--json"]].concat());
    let row = &report["histograms"][0];
    let explained = &row["likelihood_explanation"];
    assert!(row.get("explanation").is_none());
    assert_eq!(explained["depth_m"], row["estimates"][0]["depth_m"]);
    assert_eq!(explained["depth_raw"], "00ffd74c6");
    assert!(explained["status"].as_array().unwrap().is_empty());
    let values = explained["values"].as_array().unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    for value in values {
        let difference = number(&value["fixed"]) - number(&value["float"]);
        assert!((difference - number(&value["difference"])).abs() < 1e-9, "{value}");
    }
    let of = |stage: &str| values.iter().filter(|value| value["stage"] == stage).count();
    assert_eq!(["ambient", "scan", "start", "rescan", "end"].map(of), [10, 2, 4, 2, 4]);
    assert!((1..=6).all(|step| of(&format!("step {step}")) == 5));
    let depth = values.last().unwrap();
    assert_eq!((&depth["value"], &depth["unit"]), (&"depth".into(), &"m".into()));
    assert_eq!(depth["fixed"], row["estimates"][0]["depth_m"]);
    assert_eq!(depth["word"], 0x00ff_d74c6);
    assert!(number(&depth["difference"]).abs() < 0.1 * number(&explained["sigma_m"]));
}

#[test]
fn the_table_fits_a_terminal_and_says_the_status_in_words() {
    let folder = empty();
    let explained =
        |more: &[&str]| stdout(folder.path(), &[&LIKELIHOOD[..], &["--explain"], more].concat());
    let text = explained(&[]);
    let head = "0.499689 m (00ffd74c6), likelihood_estimator, sd 0.000296 m";
    assert!(text.contains(head) && text.contains("integers: accepted"), "{text}");
    assert!(text.lines().skip(1).all(|line| line.chars().count() <= 80), "{text}");
    assert!(!text.contains("l1_in"), "{text}");
    let none = explained(&["-s", "estimator.assumed_shots=65535"]);
    assert!(none.contains("integers: rejected: another echo, no fit"), "{none}");
    let both = stdout(
        folder.path(),
        &["estimate", HISTOGRAM, "--estimator", "network,likelihood_estimator", "--explain"],
    );
    assert!(both.contains("l1_in") && both.contains(head), "{both}");
    let matched = ["estimate", HISTOGRAM, "--estimator", "matched", "--explain"];
    let matched = stdout(folder.path(), &matched);
    assert!(matched.contains("l1_in") && !matched.contains("likelihood_estimator"), "{matched}");
}

#[test]
fn what_has_no_likelihood_estimator_is_refused() {
    let folder = empty();
    let set = ["--explain", "-s", "firmware.mode=1"];
    let error = refused(folder.path(), &[&LIKELIHOOD[..], &set].concat());
    let expected = "firmware.mode = 1: expected 0 for likelihood_estimator";
    assert!(error.contains(expected), "{error}");
}
