//! A chain that is not as it was when the TDC was calibrated: what a user is told.

use serde_json::Value;

use crate::common::{empty, json, output, stdout};

const DRIFT: [&str; 4] = ["-s", "tdc.temperature_c=65", "-s", "tdc.calibrated_at_c=25"];

fn notes(args: &[&str], set: &[&str]) -> Vec<(String, String)> {
    let found = json(empty().path(), &[args, &["--json"], set].concat());
    let text = |note: &Value, key: &str| note[key].as_str().unwrap().to_owned();
    let notes = found["notes"].as_array().unwrap().iter();
    notes.map(|note| (text(note, "code"), text(note, "key"))).collect()
}

#[test]
fn every_verb_that_tells_a_depth_says_that_the_chain_has_drifted() {
    let drifted = ("chain-drifted".to_owned(), "tdc.temperature_c".to_owned());
    let likelihood = ["-s", "estimator.kind=likelihood"];
    let run: &[&str] = &["run", "--fidelity", "histogram"];
    let evaluate: &[&str] =
        &["evaluate", "--estimator", "likelihood", "--grid", "target.distance_m=0.3"];
    for verb in [run, evaluate, &["budget"]] {
        let own: &[&str] = if verb[0] == "run" { &likelihood } else { &[] };
        let found = notes(verb, &[&DRIFT[..], own].concat());
        assert!(found.contains(&drifted), "{verb:?}: {found:?}");
        let calibrated = notes(verb, &[&DRIFT[..2], own].concat());
        assert!(!calibrated.iter().any(|(code, _)| code == "chain-drifted"), "{verb:?}");
    }
    let args = ["run", "--waves", "none", "-s", "estimator.kind=likelihood"];
    let said = output(empty().path(), &[&args[..], &DRIFT].concat()).stderr;
    let said = String::from_utf8(said).unwrap();
    let line = "note: tdc.temperature_c = 65: the TDC was calibrated at 25: an age of a whole period of clk_sys is \
                off by -307.7 ps, others in proportion (expected 25) [chain-drifted]";
    assert!(said.contains(line), "{said}");
    let strict = output(empty().path(), &[&args[..], &DRIFT, &["--strict"]].concat());
    assert_eq!(strict.status.code(), Some(2));
}

#[test]
fn the_supply_is_named_where_it_makes_more_of_it() {
    let set = ["-s", "tdc.supply_mv=20", "-s", "tdc.calibrated_at_mv=0"];
    let text = stdout(empty().path(), &[&["budget", "--json"], &set[..]].concat());
    assert!(text.contains("\"key\":\"tdc.supply_mv\"") && text.contains("+163.3 ps"), "{text}");
}
