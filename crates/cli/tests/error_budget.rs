//! `tofsim budget --errors`: tables, JSON, files that can be made again, and what is refused.

use std::fs;

use serde_json::Value;

use crate::common::{empty, json, output, refused, stdout};

const FEW: [&str; 6] =
    ["budget", "--errors", "--frames", "40", "-s", "firmware.shots_per_frame=3000"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&FEW, more].concat()
}

/// The row of an effect at the first point.
fn row<'a>(found: &'a Value, effect: &str) -> &'a Value {
    let rows = found["points"][0]["effects"].as_array().unwrap();
    rows.iter().find(|row| row["effect"] == effect).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

#[test]
fn tables_fit_the_terminal_and_say_what_is_off_or_left_out_and_why() {
    for (more, words) in [
        (
            &[][..],
            &["all off", "shot noise", "tansig table", "pile-up: the network was trained"][..],
        ),
        (
            &["--estimator", "likelihood", "-s", "tdc.profile=kintex7"],
            &["pile-up", "pulse width", "DNL", "dead time: firmware.mode = 0", "drift: "],
        ),
        (&["--estimator", "peak", "-s", "target.reflectance=0.03"], &["without a depth"]),
        (&["-s", "spad.afterpulse_probability=0.2"], &["afterpulses"]),
    ] {
        let text = stdout(empty().path(), &with(more));
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        for words in words.iter().chain(&["all together", "Cramer-Rao bound", "alone in sum"]) {
            assert!(text.contains(words), "{words}: {text}");
        }
    }
}

#[test]
fn the_object_has_each_effect_with_figures_or_a_reason() {
    let found = json(empty().path(), &with(&["--estimator", "likelihood", "--json"]));
    assert_eq!(found["schema"], "tofsim.errors/1");
    assert_eq!((&found["estimator"], &found["key"]), (&"likelihood".into(), &Value::Null));
    assert_eq!((&found["frames_per_variant"], &found["scenario"]), (&40.into(), &"kc705".into()));
    assert!(found["notes"].is_array() && found["hash"].is_string() && found["set"].is_array());
    let point = &found["points"][0];
    assert_eq!(point["effects"].as_array().unwrap().len(), 21);
    for row in point["effects"].as_array().unwrap() {
        let is_on = row["state"] == "on";
        assert_eq!(row["alone"].is_object() && row["all_but"].is_object(), is_on, "{row}");
        assert_eq!(row["reason"].is_string(), !is_on, "{row}");
    }
    let noise = row(&found, "shot_noise");
    assert_eq!(number(&noise["all_but"]["two_sd_mm"]), 0.0);
    let (alone, all) =
        (number(&noise["alone"]["two_sd_mm"]), number(&point["all_together"]["two_sd_mm"]));
    assert!(alone < 0.5 * all, "without pulse, pile-up and ambient light: {alone} of {all}");
    let less = number(&noise["together_less_all_but"]["variance_mm2"]);
    assert!((less - all * all / 4.0).abs() < 1e-9 * less.abs());
    assert!(
        number(&point["cramer_rao_two_sd_mm"]) > number(&point["cramer_rao_two_sd_fine_bins_mm"])
    );
}

#[test]
fn every_instrument_and_estimator_has_a_budget() {
    let few = ["budget", "--errors", "--frames", "2", "--json", "-q"];
    for instrument in ["kc705", "far", "near", "bright", "long", "fine", "compact", "ecp5"] {
        let found = json(empty().path(), &[&few[..], &[instrument]].concat());
        assert_eq!(found["estimator"], "network", "{instrument}");
        assert!(found["points"][0]["all_together"]["mean_mm"].is_number(), "{instrument}: {found}");
        let found =
            json(empty().path(), &[&few[..], &[instrument, "--estimator", "likelihood"]].concat());
        assert!(found["points"][0]["all_together"]["mean_mm"].is_number(), "{instrument}: {found}");
    }
    for kind in ["network", "centroid", "likelihood"] {
        let set = format!("estimator.kind={kind}");
        let found = json(empty().path(), &[&few[..], &["-s", &set]].concat());
        let expected = if kind == "likelihood" { "likelihood_estimator" } else { kind };
        assert_eq!(found["estimator"], expected);
        assert_eq!(row(&found, "fixed_point")["state"], "on", "{kind}");
    }
    for kind in ["network-float", "peak", "matched"] {
        let found = json(empty().path(), &[&few[..], &["--estimator", kind]].concat());
        assert_eq!(row(&found, "fixed_point")["state"], "off", "{kind}");
    }
}

#[test]
fn the_number_of_threads_changes_no_byte_and_the_seed_does() {
    let of = |more: &[&str]| stdout(empty().path(), &with(&[&["--json"], more].concat()));
    let strip = |text: String| -> Value {
        let mut object: Value = serde_json::from_str(&text).unwrap();
        object["command"] = Value::Null;
        object
    };
    assert_eq!(of(&["--threads", "1"]), of(&["--threads", "2"]));
    let [one, other] = ["1", "2"].map(|seed| strip(of(&["--seed", seed])));
    assert_ne!(one["points"], other["points"]);
    assert_eq!((&one["seed"], &other["seed"]), (&1.into(), &2.into()));
    assert_eq!(one["points"], strip(of(&[]))["points"]);
}

#[test]
fn files_over_a_grid_can_be_made_again() {
    let folder = empty();
    let here = folder.path();
    let grid = ["--grid", "target.distance_m=0.2,0.5", "--estimator", "centroid"];
    stdout(here, &with(&[&grid[..], &["-o", "out"]].concat()));
    for name in ["errors.json", "errors.csv", "errors.svg"] {
        let path = format!("out/{name}");
        assert_eq!(stdout(here, &["rerun", &path]), format!("{path}: the same\n"));
    }
    fs::write(here.join("printed.json"), stdout(here, &with(&[&grid[..], &["--json"]].concat())))
        .unwrap();
    assert!(stdout(here, &["rerun", "printed.json"]).contains("the same"));
    let found: Value =
        serde_json::from_str(&fs::read_to_string(here.join("out/errors.json")).unwrap()).unwrap();
    assert_eq!(found["key"], "target.distance_m");
    let values: Vec<_> =
        found["points"].as_array().unwrap().iter().map(|at| number(&at["value"])).collect();
    assert_eq!(values, [0.2, 0.5]);
    let csv = fs::read_to_string(here.join("out/errors.csv")).unwrap();
    let mut lines = csv.lines().skip_while(|line| line.starts_with('#'));
    let header = lines.next().unwrap();
    assert!(header.starts_with("target.distance_m,effect,state,alone_mean_mm,"), "{header}");
    let rows: Vec<_> = lines.collect();
    assert_eq!(rows.len(), 2 * (21 + 2));
    let fields = header.split(',').count();
    assert!(rows.iter().all(|row| row.split(',').count() == fields), "{csv}");
    let noise = rows.iter().find(|row| row.starts_with("0.2,shot_noise,on,")).unwrap();
    let alone: f64 = noise.split(',').nth(3).unwrap().parse().unwrap();
    assert_eq!(alone, number(&row(&found, "shot_noise")["alone"]["mean_mm"]));
    // Two charts with a bar for each effect and point.
    let svg = fs::read_to_string(here.join("out/errors.svg")).unwrap();
    roxmltree::Document::parse(&svg).unwrap();
    for words in ["bias [mm]", "variance [mm^2]", "target.distance_m", "pile-up", "all together"] {
        assert!(svg.contains(words), "{words}");
    }
}

#[test]
fn a_grid_at_the_scenario_s_own_value_is_the_budget_of_the_scenario() {
    let folder = empty();
    let own = json(folder.path(), &with(&["--json"]));
    let grid = json(folder.path(), &with(&["--json", "--grid", "target.distance_m=0.3,0.5"]));
    assert_eq!(own["points"][0], grid["points"][1]);
}

#[test]
fn a_scenario_outside_of_the_training_has_a_note() {
    let args = with(&["-s", "target.distance_m=0.8", "--json"]);
    let found = json(empty().path(), &args);
    assert_eq!(found["notes"][0]["code"], "outside-training");
    let said = output(empty().path(), &args);
    assert!(String::from_utf8_lossy(&said.stderr).contains("target.distance_m = 0.8"));
    assert!(refused(empty().path(), &[&args[..], &["--strict"]].concat()).contains("--strict"));
}

#[test]
fn what_has_no_budget_is_refused() {
    let folder = empty();
    let here = folder.path();
    fs::write(here.join("file"), "").unwrap();
    for (more, expected) in [
        (&["--estimator", "guess"][..], "'guess' for '--estimator"),
        (&["--estimator", "subtraction"], "subtraction"),
        (&["--frames", "0"], "expected a whole number from 2"),
        (&["--frames", "-3"], "--frames"),
        (&["--threads", "0"], "--threads"),
        (&["-o", "file/folder"], "file/folder"),
        (&["--grid", "target.distance_m"], "--grid"),
        (&["--grid", "target.colour=1,2"], "target.colour"),
        (&["--grid", "target.distance_m=0.1,5"], "target.distance_m = 5"),
        (
            &["--grid", "target.distance_m=0.1,0.2", "-s", "target.distance_m=0.3"],
            "which --grid has",
        ),
        (&["-s", "firmware.laser_en=false"], "firmware.laser_en = false"),
        (&["-s", "firmware.dark_frames=true"], "firmware.dark_frames = true"),
        (&["-s", "firmware.mode=1", "--estimator", "likelihood_estimator"], "firmware.mode = 1"),
        (&["nowhere"], "nowhere"),
    ] {
        let args: Vec<_> = [&["budget", "--errors"], more].concat();
        let error = refused(here, &args);
        assert!(error.contains(expected), "{more:?}: {error}");
    }
    // Its options are no options of the link budget.
    assert!(refused(here, &["budget", "--frames", "5"]).contains("--errors"));
    assert!(refused(here, &["budget", "-o", "out"]).contains("--errors"));
}
