//! The instruments that come with the program: each fits together, holds what it was trained for, and is as exact
//! as its page says.

use serde_json::Value;

use crate::common::{empty, json, output, refused};

/// Name, bins, cycles of an estimation, width of a bin [ps].
const INSTRUMENTS: [(&str, usize, u64, f64); 5] = [
    ("kc705", 256, 267, 25.0),
    ("long", 1024, 1039, 68.0),
    ("fine", 256, 267, 12.5),
    ("compact", 64, 73, 100.0),
    ("ecp5", 128, 139, 50.0),
];
/// Depth of a picosecond of arrival time [mm].
const MM_PER_PS: f64 = 0.149_896;
/// Most that twice the standard deviation may be, of the Cramer-Rao bound, in the median over the distances [1].
const TIMES_THE_BOUND: f64 = 8.0;

#[test]
fn a_frame_of_each_is_within_what_its_network_was_trained_for() {
    for (name, bins, cycles, _) in INSTRUMENTS {
        let folder = empty();
        let frame = json(folder.path(), &["run", name, "--waves", "none", "--json", "-o", "out"]);
        assert_eq!(frame["notes"], Value::Array(Vec::new()), "{name}");
        let frame = &frame["frames"][0];
        assert_eq!(frame["histogram"].as_array().unwrap().len(), bins, "{name}");
        assert_eq!(frame["estimator_cycles"], cycles, "{name}");
        let [truth, depth] = ["true_depth_m", "depth_m"].map(|key| frame[key].as_f64().unwrap());
        assert!((depth - truth).abs() < 0.02 * truth, "{name}: {depth} of {truth}");
    }
}

#[test]
#[ignore = "long: ./check --full"]
fn each_network_is_within_eight_times_the_bound_over_its_own_grid() {
    for (name, _, _, bin_ps) in INSTRUMENTS {
        let limit = ["--outlier-limit-mm", if name == "long" { "1000" } else { "100" }];
        let args = ["evaluate", "--scenario", name, "--rows", "12000", "--check", "1", "--json"];
        let found = json(empty().path(), &[&args[..], &limit].concat());
        assert_eq!(found["notes"], Value::Array(Vec::new()), "{name}");
        let network = &found["estimators"][0];
        let all = &network["all"];
        assert_eq!((&all["outliers"], &all["failures"]), (&0.into(), &0.into()), "{name}: {all}");
        let mean_mm = all["mean_mm"].as_f64().unwrap();
        assert!(mean_mm.abs() < 0.1 * bin_ps * MM_PER_PS, "{name}: {mean_mm} mm");
        let at = |m: &Value| {
            let groups = network["by_distance_m"].as_array().unwrap();
            groups.iter().find(|group| group["value"] == *m).unwrap()["two_sd_mm"].as_f64().unwrap()
        };
        let own = found.get("distances_m").unwrap_or(&found["thesis"]["distances_m"]);
        let bounds = found["cramer_rao_two_sd_mm"].as_array().unwrap();
        let pairs = own.as_array().unwrap().iter().zip(bounds);
        let mut ratios: Vec<_> = pairs.map(|(m, mm)| at(m) / mm.as_f64().unwrap()).collect();
        ratios.sort_by(f64::total_cmp);
        let median = ratios[ratios.len() / 2];
        assert!(median < TIMES_THE_BOUND, "{name}: {median} times the bound");
    }
}

#[test]
fn a_build_takes_the_network_of_each_as_it_is() {
    for (name, ..) in INSTRUMENTS {
        let folder = empty();
        let steps = ["--steps", "network,verilog,constraints"];
        let built = output(folder.path(), &[&["build", name, "-o", "out"][..], &steps].concat());
        let said = String::from_utf8_lossy(&built.stderr).into_owned();
        assert!(built.status.success() && !said.contains("trained, because"), "{name}: {said}");
        let own = folder.path().join("out/network.toml");
        let network = if name == "kc705" { "uniform" } else { name };
        let known = format!("{}/../../stimuli/networks/{network}.toml", env!("CARGO_MANIFEST_DIR"));
        assert_eq!(std::fs::read(own).unwrap(), std::fs::read(known).unwrap(), "{name}");
        let kind = if ["compact", "ecp5"].contains(&name) { "lpf" } else { "xdc" };
        assert!(folder.path().join(format!("out/constraints.{kind}")).exists(), "{name}");
    }
}

#[test]
fn what_a_file_says_of_its_training_is_refused_where_it_stands() {
    let text = include_str!("../../../../stimuli/instruments/compact.toml");
    for (from, to, expected) in [
        (
            "\"short\"",
            "\"shrot\"",
            "shrot: no such file; built-in recipes are short, brief, long, trainlm, uniform-16, quick",
        ),
        (
            "0.15..0.6:0.0025",
            "0.6..0.15:0.0025",
            "scenario own: training.grid: target.distance_m = 0.6..0.15:0.0025",
        ),
        ("\"target.distance_m\"", "\"target.distnce_m\"", "did you mean `distance_m`?"),
    ] {
        let folder = empty();
        assert!(text.contains(from), "{from}");
        std::fs::write(folder.path().join("own.toml"), text.replace(from, to)).unwrap();
        for verb in [&["build", "own.toml", "-o", "out"][..], &["train", "own.toml", "-o", "net"]] {
            let error = refused(folder.path(), verb);
            assert!(error.contains(expected), "{verb:?}: {error}");
        }
    }
}
