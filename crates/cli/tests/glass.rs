//! Cover glass and second surfaces on the command line: figures, causes, notes, the error budget, and what is refused.

use std::fs;

use serde_json::Value;

use crate::common::{empty, json, refused, stdout};

const GLASS: &str = "cover.fraction=1e-4";
const NET: &str = "target.second_share=0.4";

fn set<'a>(verb: &[&'a str], keys: &[&'a str]) -> Vec<&'a str> {
    verb.iter().copied().chain(keys.iter().flat_map(|key| ["-s", key])).collect()
}

fn keys(found: &Value, code: &str) -> Vec<String> {
    let notes = found["notes"].as_array().unwrap().iter().filter(|note| note["code"] == code);
    notes.map(|note| note["key"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn a_budget_has_the_photons_of_window_and_second_surface_where_there_are_such() {
    let folder = empty();
    let table = |keys: &[&str]| stdout(folder.path(), &set(&["budget"], keys));
    let rows = ["cover", "second surface", "second ambient"];
    let has = |text: &str, row| text.lines().any(|line| line.trim_start().starts_with(row));
    let (plain, both) = (table(&[]), table(&[GLASS, NET]));
    for row in rows {
        assert!(!has(&plain, row) && has(&both, row), "{row}: {both}");
    }
    let of = |keys: &[&str]| json(folder.path(), &set(&["budget", "--json"], keys));
    let (plain, glass, both) = (of(&[]), of(&[GLASS]), of(&[GLASS, NET]));
    let number = |of: &Value, key: &str| of[key].as_f64().unwrap();
    assert!(plain["cover_per_shot"].is_null() && plain["second_per_shot"].is_null());
    assert_eq!(number(&glass, "cover_per_shot"), number(&both, "cover_per_shot"));
    let share = number(&both, "signal_per_shot") / number(&plain, "signal_per_shot");
    assert!((share - 0.6).abs() < 1e-9, "{share}");
    // The window takes photons of the echo.
    assert_eq!(number(&glass, "signal_per_shot"), number(&plain, "signal_per_shot"));
    let first = |of: &Value| number(of, "signal_first_probability");
    assert!(first(&glass) < 0.5 * first(&plain), "{} of {}", first(&glass), first(&plain));
    assert!(number(&glass, "hit_probability") > number(&plain, "hit_probability"));
}

#[test]
fn events_name_the_window_as_the_cause_of_its_avalanches() {
    let folder = empty();
    let run = ["run", "glass", "--waves", "none", "--events", "shots.csv"];
    let night = ["ambient.irradiance_w_m2_nm=0", "firmware.shots_per_frame=2000"];
    stdout(folder.path(), &set(&run, &night));
    let text = fs::read_to_string(folder.path().join("shots.csv")).unwrap();
    let count =
        |cause: &str| text.lines().filter(|line| line.contains(&format!(",{cause},"))).count();
    let budget = json(folder.path(), &set(&["budget", "glass", "--json"], &night));
    let share = |key: &str| budget[key].as_f64().unwrap();
    // It comes first, and nothing before it.
    let expected = 2000.0 * (1.0 - (-share("cover_per_shot")).exp());
    let found = count("cover") as f64;
    assert!((found - expected).abs() < 5.0 * expected.sqrt(), "{found} for {expected}");
    let expected = 2000.0 * share("signal_first_probability");
    let found = count("signal") as f64;
    assert!((found - expected).abs() < 5.0 * expected.sqrt(), "{found} for {expected}");
}

#[test]
fn who_takes_light_for_one_echo_says_so_behind_glass_and_with_two_targets() {
    let folder = empty();
    let base = ["run", "--json", "--waves", "none", "--fidelity", "histogram"];
    let run = |verb: &[&str], key| json(folder.path(), &set(&[&base, verb].concat(), &[key]));
    for (key, name) in [(GLASS, "cover.fraction"), (NET, "target.second_share")] {
        let found = run(&[], key);
        assert!(keys(&found, "outside-training").contains(&name.to_owned()), "{found}");
        assert_eq!(keys(&found, "second-opinion").len(), 1);
        for estimator in ["likelihood", "likelihood_estimator", "matched", "centroid", "peak"] {
            let found = run(&["--estimator", estimator], key);
            let notes = keys(&found, "estimator-outside-model");
            assert!(notes.contains(&name.to_owned()), "{estimator}: {notes:?}");
        }
        assert!(
            refused(folder.path(), &set(&[&base[..], &["--strict"]].concat(), &[key]))
                .contains(name)
        );
        let errors = ["budget", "--errors", "--json", "--frames", "8", "--estimator", "likelihood"];
        let found = json(folder.path(), &set(&errors, &[key, "firmware.shots_per_frame=3000"]));
        let point = &found["points"][0];
        let is_unknown = point["cramer_rao_two_sd_mm"].is_null();
        assert_eq!(is_unknown, key == GLASS, "a window without a template has no bound: {point}");
        let own = if key == GLASS { "cover" } else { "second_target" };
        for row in point["effects"].as_array().unwrap() {
            if ["cover", "second_target"].contains(&row["effect"].as_str().unwrap()) {
                let state = if row["effect"] == own { "on" } else { "off" };
                assert_eq!(row["state"], state, "{row}");
            }
        }
    }
    let two = |key| keys(&run(&["--estimator", "two-echoes"], key), "estimator-outside-model");
    assert_eq!((two(GLASS), two(NET)), (vec!["cover.fraction".to_owned()], vec![]));
}

#[test]
fn a_window_behind_the_target_is_refused_by_its_key() {
    let found = refused(empty().path(), &set(&["budget"], &[GLASS, "cover.delay_ps=9000"]));
    assert!(found.contains("cover.delay_ps = 9000: expected 3335.6 [ps] at most"), "{found}");
    let found = refused(empty().path(), &set(&["budget"], &["cover.fraction=-0.1"]));
    assert!(found.contains("cover.fraction=-0.1") && found.contains("from 0.0 to 1.0"), "{found}");
}
