//! `evaluate --estimator subtraction`.

use serde_json::Value;

use crate::common::{empty, json, output};

#[test]
fn evaluate_draws_pairs_of_its_own_and_leaves_the_others_as_they_were() {
    let folder = empty();
    let evaluate = |estimators: &str, threads: &str| {
        let options = ["--rows", "1020", "--check", "0", "--seed", "2", "--threads", threads];
        json(
            folder.path(),
            &[&["evaluate", "--json", "--estimator", estimators][..], &options].concat(),
        )
    };
    let all = evaluate("network,subtraction,peak", "1");
    assert_eq!(evaluate("network,subtraction,peak", "3"), all);
    let of = |report: &Value, name: &str| {
        let estimators = report["estimators"].as_array().unwrap();
        estimators.iter().find(|one| one["name"] == name).unwrap().clone()
    };
    let without = evaluate("peak,network", "2");
    for name in ["peak", "network"] {
        assert_eq!(of(&without, name), of(&all, name), "{name}");
    }
    assert_eq!(of(&evaluate("subtraction", "2"), "subtraction"), of(&all, "subtraction"));
    let figures = of(&all, "subtraction");
    let count = |key: &str| figures["all"][key].as_u64().unwrap();
    assert_eq!(count("estimates") + count("failures"), 1020);
    let plain = of(&all, "peak")["all"]["failures"].as_u64().unwrap();
    assert!((plain + 1..200).contains(&count("failures")), "{figures}");
    assert_ne!(figures["all"]["mean_mm"], of(&all, "peak")["all"]["mean_mm"]);
    let told = output(
        folder.path(),
        &["evaluate", "--rows", "51", "--check", "0", "--estimator", "subtraction"],
    );
    let told = String::from_utf8(told.stdout).unwrap();
    assert!(told.contains("subtraction: 15000 dark and 15000 lit shots each"), "{told}");
}
