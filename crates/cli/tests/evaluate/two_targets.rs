//! Errors of both targets, each beside the true distance of the one that an estimator means.

use serde_json::Value;

use crate::common::{empty, json, stdout};

const NET: [&str; 10] = [
    "evaluate",
    "--scenario",
    "net",
    "--repeats",
    "40",
    "--check",
    "0",
    "--json",
    "-s",
    "estimator.targets=2",
];
/// Its scene alone, which is no grid's otherwise.
const SCENE: [&str; 2] = ["--grid", "target.distance_m=0.7"];

fn named<'a>(report: &'a Value, name: &str) -> &'a Value {
    let mut estimators = report["estimators"].as_array().unwrap().iter();
    estimators.find(|one| one["name"] == name).unwrap_or_else(|| panic!("{name}: {report}"))
}

/// Mean error and two standard deviations [mm], and failures.
fn figures(report: &Value, name: &str) -> (f64, f64, u64) {
    let all = &named(report, name)["all"];
    let mm = |key: &str| all[key].as_f64().unwrap();
    (mm("mean_mm"), mm("two_sd_mm"), all["failures"].as_u64().unwrap())
}

#[test]
fn each_depth_is_compared_with_the_target_that_is_meant() {
    let folder = empty();
    for order in ["nearest", "strongest"] {
        let order = format!("estimator.order={order}");
        let of = ["-s", &order, "--estimator", "likelihood_estimator,two-echoes"];
        let report = json(folder.path(), &[&NET[..], &SCENE, &of].concat());
        for name in ["likelihood_estimator", "two-echoes"] {
            // Taken for each other, both would be off by 350 mm.
            for name in [name.to_owned(), format!("{name}-second")] {
                let (mean_mm, two_sd_mm, failures) = figures(&report, &name);
                assert!(mean_mm.abs() < 0.5 && two_sd_mm < 3.0, "{order} {name}: {mean_mm} mm");
                assert_eq!(failures, 0, "{order} {name}");
            }
        }
        let [first, second] = ["likelihood_estimator", "likelihood_estimator-second"]
            .map(|name| figures(&report, name).1);
        // The net, which is nearer, is known better than the wall.
        assert_eq!(first < second, order.ends_with("nearest"), "{order}: {first} {second}");
    }
}

#[test]
fn scenes_without_a_second_surface_have_no_second_target() {
    let folder = empty();
    let grid = ["--grid", "target.second_share=0,0.3"];
    let report = json(folder.path(), &[&NET[..], &SCENE, &grid].concat());
    let counts = |name: &str| {
        let all = &named(&report, name)["all"];
        all["estimates"].as_u64().unwrap() + all["failures"].as_u64().unwrap()
    };
    assert_eq!(counts("likelihood_estimator"), 80);
    assert_eq!(counts("likelihood_estimator-second"), 40);
    let set = ["-s", "target.second_share=0"];
    let report = json(folder.path(), &[&NET[..], &SCENE, &set].concat());
    assert_eq!(report["estimators"].as_array().unwrap().len(), 1, "{report}");
}

#[test]
fn settings_that_look_for_one_target_have_no_second() {
    let folder = empty();
    let args = ["--scenario", "net", "--repeats", "20", "--check", "0", "--json"];
    let grid = ["--grid", "estimator.targets=1,2"];
    let report = json(folder.path(), &[&["evaluate"][..], &args, &SCENE, &grid].concat());
    let counts = |name: &str| {
        let all = &named(&report, name)["all"];
        [&all["estimates"], &all["failures"]].map(|count| count.as_u64().unwrap())
    };
    assert_eq!(counts("likelihood_estimator").iter().sum::<u64>(), 40);
    assert_eq!(counts("likelihood_estimator-second"), [20, 0]);
}

#[test]
fn a_run_states_both_true_distances_in_the_order_of_the_firmware() {
    let folder = empty();
    let run = ["run", "net", "--waves", "none", "--fidelity", "shot", "--no-second-opinion"];
    let of = |set: &str, more: &[&str]| {
        let set = ["-s", "estimator.targets=2", "-s", set];
        stdout(folder.path(), &[&run[..], &set, more].concat())
    };
    let text = of("estimator.order=nearest", &[]);
    assert!(text.contains("0.350000 m, second target 0.700000 m\n"), "{text}");
    let frame = |set: &str| {
        let report: Value = serde_json::from_str(&of(set, &["--json"])).unwrap();
        let frame = &report["frames"][0];
        [&frame["true_depth_m"], &frame["second_true_depth_m"]].map(Value::clone)
    };
    assert_eq!(frame("estimator.order=strongest"), [Value::from(0.7), Value::from(0.35)]);
    assert_eq!(frame("estimator.kind=network"), [Value::from(0.7), Value::Null]);
}

#[test]
fn a_sweep_compares_with_the_target_that_is_reported_first() {
    let folder = empty();
    let plan = "scenario = \"net\"\nset = [\"estimator.targets=2\"]\nfidelity = \"shot\"\nframes = 3\n\
        estimators = [\"likelihood_estimator\", \"two-echoes\"]\noutputs = [\"*.bias_mm\"]\n\
        [[axis]]\nkey = \"estimator.order\"\nvalues = [\"nearest\", \"strongest\"]\n";
    std::fs::write(folder.path().join("plan.toml"), plan).unwrap();
    let found = json(folder.path(), &["sweep", "plan.toml", "--json"]);
    for row in found["rows"].as_array().unwrap() {
        for column in ["likelihood_estimator.bias_mm", "two-echoes.bias_mm"] {
            let bias_mm = row[column].as_f64().unwrap_or_else(|| panic!("{column} of {row}"));
            assert!(bias_mm.abs() < 3.0, "{column} of {row}");
        }
    }
}
