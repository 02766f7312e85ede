//! `tofsim calibrate glass`: from histograms to a template that estimators use.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{empty, json, output, refused, stdout};

const TEMPLATE: &str = "estimator.glass_file=out/glass.csv";

/// A template of the built-in scenario behind glass, from so many simulated frames.
fn calibrated(folder: &Path, frames: &str, set: &[&str]) -> Value {
    let mut args = vec!["calibrate", "glass", "--scenario", "glass", "--frames", frames];
    set.iter().for_each(|set| args.extend(["-s", set]));
    json(folder, &[&args[..], &["-o", "out", "--json"]].concat())
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

#[test]
fn a_template_is_made_and_a_target_is_seen_through_it() {
    let folder = empty();
    let here = folder.path();
    let found = calibrated(here, "200", &[]);
    assert_eq!(found["schema"], "tofsim.glass_calibration/1");
    assert_eq!(found["keys"][0], "estimator.glass_file=glass.csv");
    let budget = json(here, &["budget", "glass", "--json"]);
    let [photons, se] = ["photons_per_shot", "photons_per_shot_se"].map(|key| number(&found[key]));
    // A part of the smeared tail is in the noise.
    let off = photons / number(&budget["cover_per_shot"]) - 1.0;
    assert!(off.abs() < 0.02 && se < 0.005 * photons, "{photons} +- {se}, {off}");
    // The laser's delay, the window's, and that of the smeared tenth.
    assert!((number(&found["mean_delay_ps"]) - 755.0).abs() < 15.0, "{found}");
    for name in ["out/glass.csv", "out/glass.svg", "out/calibration.json"] {
        assert_eq!(stdout(here, &["rerun", name]), format!("{name}: the same\n"));
    }
    let args = ["--estimator", "likelihood,two-echoes,matched", "--fidelity", "histogram"];
    let run = [&["run", "glass", "--frames", "20", "--json", "-s", TEMPLATE], &args[..]].concat();
    let run = json(here, &run);
    let depths = |name: &str| -> Vec<&Value> {
        let frames = run["frames"].as_array().unwrap().iter();
        let all = frames.flat_map(|frame| frame["estimates"].as_array().unwrap());
        all.filter(|estimate| estimate["estimator"] == name).collect()
    };
    for name in ["likelihood", "two-echoes"] {
        let found = depths(name);
        let mean = found.iter().map(|one| number(&one["depth_m"])).sum::<f64>() / 20.0;
        assert!((mean - 0.4).abs() < 5e-4, "{name}: {mean}");
        for one in found {
            let pedestal = &one["pedestal"];
            let [relative, se] = ["relative", "relative_se"].map(|key| number(&pedestal[key]));
            assert!((relative - 1.0).abs() < 5.0 * se && se < 0.02, "{pedestal}");
            assert!(number(&pedestal["misfit"]) < 5.0, "{pedestal}");
        }
    }
    assert!(depths("matched").iter().all(|one| (number(&one["depth_m"]) - 0.4).abs() < 0.01));
    let notes = run["notes"].as_array().unwrap();
    let of = |name: &str| notes.iter().any(|note| note["text"].as_str().unwrap().starts_with(name));
    assert!(!of("likelihood:") && !of("two-echoes:") && !of("matched:"), "{notes:?}");
    assert!(!notes.iter().any(|note| note["code"] == "pedestal-moved"), "{notes:?}");
}

#[test]
fn a_window_that_has_moved_is_noted_with_its_size() {
    let folder = empty();
    let here = folder.path();
    calibrated(here, "50", &[]);
    let run = |set: &str| {
        let args = ["run", "glass", "--frames", "5", "--fidelity", "histogram", "--json"];
        let more = ["--estimator", "likelihood", "-s", TEMPLATE, "-s", set];
        let found = json(here, &[&args[..], &more].concat());
        let notes = found["notes"].as_array().unwrap().iter();
        let moved: Vec<_> =
            notes.filter(|note| note["code"] == "pedestal-moved").cloned().collect();
        moved
    };
    let dirty = run("cover.fraction=1.69e-4");
    assert!((number(&dirty[0]["value"]) - 1.3).abs() < 0.03, "{dirty:?}");
    assert!(dirty[0]["text"].as_str().unwrap().contains("times that of the calibration"));
    let late = run("cover.delay_ps=150");
    assert!(late[0]["text"].as_str().unwrap().contains("another shape"), "{late:?}");
    assert_eq!(run("cover.fraction=1.32e-4"), Vec::<Value>::new());
}

#[test]
fn histograms_of_files_are_calibrated_and_a_target_among_them_is_refused() {
    let folder = empty();
    let here = folder.path();
    for (name, reflectance) in [("dark", "target.reflectance=0"), ("lit", "target.reflectance=0.3")]
    {
        let args = ["dataset", "glass", "--rows", "40", "--format", "npy", "-o", name];
        let grid = ["--grid", "target.distance_m=0.4", "--grid", reflectance];
        stdout(here, &[&args[..], &grid, &["-s", "cover.fraction=3e-5"]].concat());
    }
    let run = |file: &str| {
        let args = ["calibrate", "glass", file, "--scenario", "glass", "-s", "cover.fraction=3e-5"];
        output(here, &args)
    };
    let found = run("dark/histograms.npy");
    let text = String::from_utf8(found.stdout).unwrap();
    assert!(text.starts_with("40 histograms of 30000 shots\n"), "{text}");
    for row in ["pedestal photons per shot", "mean delay", "relative standard error", "glass.csv"] {
        assert!(text.contains(row), "{row}: {text}");
    }
    let error = String::from_utf8(run("lit/histograms.npy").stderr).unwrap();
    assert!(error.contains("lit/histograms.npy: histogram = "), "{error}");
    assert!(error.contains("a target at 0.4") || error.contains("a target at 0.39"), "{error}");
}

#[test]
fn bad_templates_and_histograms_are_refused() {
    let folder = empty();
    let here = folder.path();
    calibrated(here, "20", &[]);
    let run = |set: &[&str]| {
        let mut args = vec!["run", "glass", "-s", TEMPLATE];
        set.iter().for_each(|set| args.extend(["-s", set]));
        refused(here, &args)
    };
    for set in ["tdc.profile=kintex7", "tdc.bin_ps=20", "tdc.first_bin_ps=300"] {
        let error = run(&[set]);
        assert!(error.contains("out/glass.csv:") && error.contains("calibrate anew"), "{error}");
    }
    let error = run(&["tdc.bins=128", "estimator.kind=centroid"]);
    assert!(error.contains("code = 256 rows: expected 128, one for each bin"), "{error}");
    let text = fs::read_to_string(here.join("out/glass.csv")).unwrap();
    let lines: Vec<_> = text.lines().collect();
    let written = |text: &str| fs::write(here.join("out/glass.csv"), text).unwrap();
    let row = lines.iter().find(|line| line.starts_with("30,")).unwrap();
    let mut fields: Vec<_> = row.split(',').collect();
    fields[3] = "-0.001";
    written(&text.replace(row, &fields.join(",")));
    assert!(run(&[]).contains("hazard = -0.001: expected photons per shot"), "{}", run(&[]));
    written(&(lines[..100].join("\n") + "\n"));
    assert!(run(&[]).contains("rows: expected 256, one for each bin (tdc.bins)"), "{}", run(&[]));
    written("");
    assert!(run(&[]).contains("out/glass.csv: empty; expected the header"), "{}", run(&[]));
    written(&text);
    let mode_1 =
        ["run", "glass", "-s", TEMPLATE, "-s", "firmware.mode=1", "-s", "estimator.kind=centroid"];
    let error = refused(here, &[&mode_1[..], &["--estimator", "likelihood"]].concat());
    assert!(error.contains("estimator.glass_file: expected none in MODE 1"), "{error}");
    let calibrate = ["calibrate", "glass", "--scenario", "glass", "-s", "estimator.kind=centroid"];
    let with = |more: &[&'static str]| [&calibrate[..], more].concat();
    let mode_1 = refused(here, &with(&["-s", "firmware.mode=1", "--frames", "1"]));
    assert!(mode_1.contains("firmware.mode = 1: expected 0"), "{mode_1}");
    let none = refused(here, &with(&["-s", "cover.fraction=0", "--frames", "3"]));
    assert!(none.contains("pedestal = none: expected light of a cover window"), "{none}");
    let both = refused(here, &with(&["out/glass.csv", "--frames", "3"]));
    assert!(both.contains("--frames"), "{both}");
    let pulse = ["calibrate", "pulse", "h.csv", "-s", TEMPLATE];
    let rows: String = (0..256).map(|bin| format!("{bin},1\n")).collect();
    fs::write(here.join("h.csv"), format!("bin,count\n{rows}")).unwrap();
    let error = refused(here, &pulse);
    assert!(error.contains("estimator.glass_file = out/glass.csv: expected none"), "{error}");
}

#[test]
fn the_bound_holds_behind_glass_with_a_template_and_with_two_targets() {
    let folder = empty();
    let here = folder.path();
    calibrated(here, "100", &["cover.fraction=2e-5"]);
    let evaluate = |scenario: &str, set: &[&str]| {
        let mut args = vec!["evaluate", "--scenario", scenario, "--repeats", "40", "--estimator"];
        args.extend(["two-echoes", "--grid", "target.distance_m=0.5", "--grid"]);
        args.extend(["ambient.irradiance_w_m2_nm=0.02", "--grid", "target.reflectance=0.3"]);
        set.iter().for_each(|set| args.extend(["-s", set]));
        let found = json(here, &[&args[..], &["--json"]].concat());
        let bound = found["cramer_rao_two_sd_mm"][0].as_f64();
        (bound, found["estimators"].clone(), stdout(here, &args))
    };
    let glass = ["cover.fraction=2e-5"];
    let (bound, _, text) = evaluate("glass", &glass);
    assert_eq!(bound, None);
    assert!(text.contains("the cover window sends some back"), "{text}");
    let (bound, estimators, _) = evaluate("glass", &[glass[0], TEMPLATE]);
    let of = |name: &str| -> f64 {
        let all = estimators.as_array().unwrap();
        let own = all.iter().find(|one| one["name"] == name).unwrap();
        own["all"]["two_sd_mm"].as_f64().unwrap()
    };
    let ratio = of("two-echoes") / bound.unwrap();
    assert!((0.6..1.5).contains(&ratio), "{ratio}");
    let clear = evaluate("glass", &["cover.fraction=0"]).0.unwrap();
    assert!(bound.unwrap() > 1.02 * clear, "{bound:?} {clear}");
    // A second surface next to the target costs more than one that is far away.
    let two = |distance: &str| evaluate("net", &[distance]).0.unwrap();
    let [near, far] = ["target.second_distance_m=0.44", "target.second_distance_m=0.9"].map(two);
    assert!(near > 1.2 * far, "{near} {far}");
}
