//! `tofsim evaluate` and `run --estimator`: what a user sees of the estimators' errors.

use std::fs;

use serde_json::Value;

use crate::common::{self, csv, empty, json, output, refused, stdout};

mod two_targets;

const FEW: [&str; 7] = ["evaluate", "--rows", "2040", "--check", "2", "--seed", "3"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    FEW.into_iter().chain(more.iter().copied()).collect()
}

fn at<'a>(report: &'a Value, estimator: &str, distance_m: f64) -> &'a Value {
    let estimators = report["estimators"].as_array().unwrap();
    let one = estimators.iter().find(|one| one["name"] == estimator).unwrap();
    let groups = one["by_distance_m"].as_array().unwrap();
    groups.iter().find(|group| group["value"].as_f64() == Some(distance_m)).unwrap()
}

#[test]
fn what_is_measured_is_the_estimator_of_the_scenarios_firmware() {
    let folder = empty();
    let names = |set: &str| {
        let args = ["evaluate", "--rows", "200", "--check", "0", "--json", "-s", set];
        let report = json(folder.path(), &args);
        let all = report["estimators"].as_array().unwrap().iter();
        all.map(|one| one["name"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names("estimator.kind=network"), ["network", "network-float"]);
    assert_eq!(names("estimator.kind=centroid"), ["centroid"]);
    assert_eq!(names("estimator.kind=likelihood"), ["likelihood_estimator"]);
}

#[test]
fn every_estimator_is_measured_on_the_same_histograms() {
    let folder = empty();
    let all = "network,network-float,peak,likelihood,likelihood_estimator,matched";
    let report = json(folder.path(), &with(&["--estimator", all, "--json"]));
    assert_eq!(report["schema"], "tofsim.evaluate/1");
    assert_eq!((&report["rows"], &report["seed"]), (&2040.into(), &3.into()));
    for name in all.split(',') {
        let of_grid = report["estimators"].as_array().unwrap();
        let one = of_grid.iter().find(|one| one["name"] == name).unwrap();
        assert_eq!(one["by_distance_m"].as_array().unwrap().len(), 51);
        for key in ["by_distance_m", "by_reflectance", "by_irradiance_w_m2_nm"] {
            let groups = one[key].as_array().unwrap();
            let count = |group: &Value| {
                group["estimates"].as_u64().unwrap() + group["failures"].as_u64().unwrap()
            };
            assert_eq!(groups.iter().map(count).sum::<u64>(), 2040, "{name} {key}");
        }
    }
    // 40 histograms a distance: 2 sd is good to some 12 %.
    for (name, distance_m, most) in [
        ("network", 0.3, 4.5),
        ("likelihood", 0.3, 0.8),
        ("likelihood_estimator", 0.3, 0.8),
        ("matched", 0.5, 1.6),
    ] {
        let two_sd = at(&report, name, distance_m)["two_sd_mm"].as_f64().unwrap();
        assert!(two_sd > 0.1 && two_sd < most, "{name}: {two_sd} mm");
    }
    let peak = at(&report, "peak", 0.6);
    assert!(peak["two_sd_mm"].as_f64().unwrap() > 5.0);
    for check in report["cross_check"].as_array().unwrap() {
        assert_eq!((&check["frames"], &check["other_depths"]), (&2.into(), &0.into()));
        assert!(check["p_value"].as_f64().unwrap() > 1e-6, "{check}");
    }
    let bound = report["cramer_rao_two_sd_mm"].as_array().unwrap();
    assert!(bound.iter().all(|mm| mm.as_f64().unwrap() > 0.3));
}

#[test]
fn the_tables_stand_beside_the_thesis_and_threads_change_nothing() {
    let folder = empty();
    let text = stdout(folder.path(), &with(&["--threads", "1"]));
    assert_eq!(stdout(folder.path(), &with(&["--threads", "2"])), text);
    for row in ["Table 5.5", "Table 6.5", "Table 5.2", "Table 4.3", "Cramer-Rao", "network-float"] {
        assert!(text.contains(row), "{row} in {text}");
    }
    assert!(text.contains("0.6 m: counts as drawn"), "{text}");
    assert!(text.lines().all(|line| line.len() <= 80), "{text}");
    assert!(text.lines().nth(3).unwrap().contains("largest error"), "{text}");
}

#[test]
fn a_folder_gets_the_figures_and_the_plots() {
    let folder = empty();
    stdout(folder.path(), &with(&["-o", "out"]));
    let names = common::files(&folder.path().join("out"));
    assert_eq!(names.len(), 3 + 3 * 3 + 1, "{names:?}");
    let both = fs::read_to_string(folder.path().join("out/errors_by_distance_m.svg")).unwrap();
    for words in ["network-float", "specification (Table 5.2)", "tofsim-record"] {
        assert!(both.contains(words), "{words}");
    }
    let spread = fs::read_to_string(folder.path().join("out/spread_by_distance_m.svg")).unwrap();
    for words in ["network-float", "Cramer-Rao bound", "2σ [mm]", "distance [m]", "tofsim-record"]
    {
        assert!(spread.contains(words), "{words}");
    }
    let csv = fs::read_to_string(folder.path().join("out/evaluation.csv")).unwrap();
    assert_eq!(csv.lines().count(), 2 + 2 * (51 + 53 + 9));
    let text = fs::read_to_string(folder.path().join("out/evaluation.json")).unwrap();
    let report: Value = serde_json::from_str(&text).unwrap();
    let row = csv.lines().find(|line| line.starts_with("network,distance_m,0.3,")).unwrap();
    let two_sd = at(&report, "network", 0.3)["two_sd_mm"].as_f64().unwrap();
    let in_csv: f64 = row.split(',').nth(8).unwrap().parse().unwrap();
    // The parser of this test may miss the last bit.
    assert!((in_csv / two_sd - 1.0).abs() < 1e-12);
}

#[test]
fn a_network_on_another_chain_is_told() {
    let folder = empty();
    let told = output(folder.path(), &["evaluate", "ideal", "--rows", "51", "--check", "0"]);
    let told = String::from_utf8(told.stderr).unwrap();
    let expected =
        "note: tdc.profile = uniform: the network was not trained for it (expected ideal)";
    assert!(told.contains(expected), "{told}");
}

#[test]
fn bad_input_is_named() {
    let folder = empty();
    for (more, expected) in [
        (&["nosuch"][..], "built-in networks are uniform, ideal"),
        (&["-s", "firmware.mode=1"], "firmware.mode = 1"),
        (&["-s", "pll.jitter_rms_ps=5"], "pll.jitter_rms_ps = 5"),
        (&["--profile", "nosuch"], "nosuch"),
        (&["--estimator", "guess"], "guess"),
        (&["--rows", "0"], "0"),
    ] {
        let mut arguments = vec!["evaluate", "--check", "0"];
        arguments.extend(more);
        let error = refused(folder.path(), &arguments);
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn a_run_shows_what_other_estimators_say_of_its_frames() {
    let folder = empty();
    let arguments = ["run", "--waves", "none", "--estimator", "matched,peak,network"];
    let text = stdout(folder.path(), &arguments);
    let row = text.lines().find(|line| line.trim_start().starts_with("matched")).unwrap();
    assert!(row.trim_end().ends_with("mm"), "{row}");
    let report = json(folder.path(), &[&arguments[..], &["--frames", "2", "--json"]].concat());
    for frame in report["frames"].as_array().unwrap() {
        let estimates = frame["estimates"].as_array().unwrap();
        assert_eq!(estimates.len(), 3);
        assert_eq!(estimates[2]["depth_m"], frame["depth_m"]);
        let matched = estimates[0]["depth_m"].as_f64().unwrap();
        assert!((matched - frame["true_depth_m"].as_f64().unwrap()).abs() < 0.003);
    }
    let plain = json(folder.path(), &["run", "--waves", "none", "--json"]);
    assert!(plain["frames"][0].get("estimates").is_none());
}

#[test]
fn several_frames_give_each_estimator_mean_error_spread_outliers_and_failures() {
    let folder = empty();
    let run = |more: &[&str]| {
        let fixed = ["run", "--fidelity", "shot", "--frames", "6", "--estimator", "matched,peak"];
        stdout(folder.path(), &[&fixed[..], more].concat())
    };
    let far = ["-s", "target.distance_m=0.6", "-s", "target.reflectance=0.02", "--json"];
    let text = run(&[&far[..], &["--threads", "1"]].concat());
    assert_eq!(text, run(&[&far[..], &["--threads", "3"]].concat()));
    let report: Value = serde_json::from_str(&text).unwrap();
    let depths = |k: usize| {
        let frames = report["frames"].as_array().unwrap();
        frames.iter().filter_map(|f| f["estimates"][k]["depth_m"].as_f64()).collect::<Vec<_>>()
    };
    for (k, name) in ["matched", "peak"].into_iter().enumerate() {
        let (found, depths) = (&report["estimators"][k], depths(k));
        assert_eq!(found["estimator"], name);
        assert_eq!(found["failures"], 6 - depths.len());
        let far = depths.iter().filter(|depth| (*depth - 0.6).abs() > 0.1).count();
        assert_eq!(found["outliers"], far);
        if !depths.is_empty() {
            let mean = depths.iter().sum::<f64>() / depths.len() as f64;
            assert!((found["mean_m"].as_f64().unwrap() - mean).abs() < 1e-12);
            assert!((found["mean_error_m"].as_f64().unwrap() - (mean - 0.6)).abs() < 1e-12);
        }
    }
    let table = run(&["--outlier-limit-mm", "0.001"]);
    let row = |name: &str| {
        let line = table.lines().find(|line| line.trim_start().starts_with(name)).unwrap();
        line.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(row("truth"), ["truth", "0.500000"]);
    assert_eq!(row("outliers"), ["outliers", "6", "6", "6"], "{table}");
    assert_eq!(row("failures"), ["failures", "-", "0", "0"], "{table}");
    assert_eq!(row("mean").len() + row("2σ").len() + row("error").len(), 4 + 4 + 5);
}

#[test]
fn an_evaluation_counts_outliers_by_the_stated_limit() {
    let folder = empty();
    let report = |more: &[&str]| {
        let some = ["--estimator", "centroid,likelihood", "--json"];
        json(folder.path(), &with(&[&some[..], more].concat()))
    };
    let (usual, strict) = (report(&[]), report(&["--outlier-limit-mm", "5"]));
    let all = |report: &Value, k: usize| report["estimators"][k]["all"].clone();
    assert_eq!(all(&usual, 0)["outliers"], 0);
    assert_eq!(strict["outlier_limit_mm"], 5.0);
    assert!(all(&strict, 0)["outliers"].as_u64().unwrap() > 1000, "{}", all(&strict, 0));
    assert_eq!(all(&strict, 1)["outliers"], 0);
    let group = at(&strict, "centroid", 0.1);
    assert_eq!(group["outliers"], group["estimates"]);
    assert!(group["mean_se_mm"].is_number() && group["two_sd_se_mm"].is_number());
    let text = refused(folder.path(), &with(&["--outlier-limit-mm", "0"]));
    assert!(text.contains("--outlier-limit-mm") && text.contains("above 0"), "{text}");
}

#[test]
fn an_estimator_says_what_it_does_not_know() {
    let folder = empty();
    let told = |args: &[&str]| {
        let out = output(folder.path(), args);
        (out.status.code(), String::from_utf8(out.stderr).unwrap())
    };
    let run = ["run", "--waves", "none", "-s", "firmware.mode=1", "--estimator"];
    let (_, text) = told(&[&run[..], &["matched"]].concat());
    assert!(text.contains("note: firmware.mode = 1: matched: "), "{text}");
    assert!(text.contains("[estimator-outside-model]"), "{text}");
    let (_, text) = told(&[&run[..], &["likelihood"]].concat());
    assert!(!text.contains("likelihood: "), "{text}");
    let (status, text) = told(&[&run[..], &["likelihood_estimator"]].concat());
    assert_eq!(status, Some(2));
    assert!(text.contains("firmware.mode = 1: expected 0 for likelihood_estimator"), "{text}");
    let wide = ["--estimator", "peak", "-s", "laser.pulse_sigma_ps=200"];
    let (_, text) = told(&with(&wide));
    assert!(text.contains("note: laser.pulse_sigma_ps = 200: peak: "), "{text}");
    let (status, _) = told(&with(&[&wide[..], &["--strict"]].concat()));
    assert_eq!(status, Some(2));
}

#[test]
fn what_is_written_does_not_depend_on_the_folder() {
    let stimuli = concat!(env!("CARGO_MANIFEST_DIR"), "/../../stimuli");
    let homes = [empty(), empty()];
    let written = homes.each_ref().map(|home| {
        let home = home.path();
        fs::create_dir_all(home.join("scenes/far")).unwrap();
        fs::write(home.join("scenes/far/s.toml"), stdout(home, &["scenario", "show"])).unwrap();
        fs::copy(home.join("scenes/far/s.toml"), home.join("s.toml")).unwrap();
        fs::copy(format!("{stimuli}/networks/ideal.toml"), home.join("net.toml")).unwrap();
        fs::copy(format!("{stimuli}/chains/ideal.toml"), home.join("chain.toml")).unwrap();
        let mut all = Vec::new();
        for scenario in ["s.toml", "scenes/far/s.toml"] {
            let args = [
                "evaluate",
                "./net.toml",
                "--scenario",
                scenario,
                "--rows",
                "51",
                "--check",
                "1",
                "--json",
            ];
            all.push(stdout(home, &args));
            all.push(stdout(home, &[&args[..], &["--profile", "./chain.toml"]].concat()));
            fs::write(home.join("h.csv"), csv(&vec![3; 256])).unwrap();
            let args = ["estimate", "h.csv", "--network", "./net.toml", "--scenario", scenario];
            all.push(stdout(home, &[&args[..], &["--json"]].concat()));
        }
        // The hash of a file that is named by its whole path.
        let whole = format!("estimator.network={:?}", home.join("net.toml").display().to_string());
        let budget = json(home, &["budget", "-s", &whole, "--json"]);
        all.push(budget["hash"].to_string());
        all
    });
    for (here, there) in written[0].iter().zip(&written[1]) {
        assert_eq!(here, there);
    }
}

#[test]
fn too_few_errors_have_no_standard_error_and_a_missing_bound_has_a_reason() {
    let folder = empty();
    let few = ["evaluate", "--grid", "target.distance_m=0.5", "--repeats", "2", "--check", "0"];
    let text = stdout(folder.path(), &few);
    assert!(!text.contains("+-0.00") && !text.contains("No Cramer-Rao bound"), "{text}");
    let report = json(folder.path(), &[&few[..], &["--json"]].concat());
    let found = at(&report, "network", 0.5);
    assert!(found["two_sd_mm"].is_number() && found["two_sd_se_mm"].is_null(), "{found}");
    let text = stdout(folder.path(), &[&few[..], &["-s", "laser.energy_jitter=0.3"]].concat());
    let why =
        "No Cramer-Rao bound where there is a dash: the pulse energy differs from shot to shot";
    assert!(text.replace("\n  ", " ").contains(why), "{text}");
}
