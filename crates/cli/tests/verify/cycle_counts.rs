//! `tofsim verify --cycle-counts`.

use serde_json::Value;

use crate::common;

use super::own;

/// Of few promises: tests of `tofsim-rtl` have the proofs of all, by the record.
#[test]
#[ignore = "long: ./check --full"]
fn counts_of_one_laser_period_agree_with_the_model_and_are_proven() {
    let folder = own(&["centroid_estimator.v", "likelihood_estimator.v"]);
    let periods = ["-s", "firmware.laser_periods=[6]", "-s", "firmware.laser_freq=0"];
    let args = ["verify", "--cycle-counts", "--rtl", ".", "--json"];
    let report = common::json(folder.path(), &[&args[..], &periods].concat());
    let counts = report["counts"].as_array().unwrap();
    let latency = counts.iter().find(|count| count["expected"] == 267).unwrap();
    assert_eq!((&latency["model"], &latency["rtl"]), (&267.into(), &267.into()));
    assert_eq!(counts.len(), 12);
    let holds = |count: &Value| ["model", "rtl"].iter().all(|by| count[by] == count["expected"]);
    assert!(counts.iter().all(holds), "{report}");
    assert!(counts.iter().all(|count| count["proven"] == true), "{report}");
}
