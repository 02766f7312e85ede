//! Tests that exceeded limits are noted, and nothing else is.

use serde_json::Value;

use super::common::{json, output, refused, stdout};

/// Frames of a scenario of which the error is measured.
const FRAMES: &str = "20";

/// Settings outside one limit each, and the key that a note has to name.
const OUTSIDE: &[(&str, &[&str])] = &[
    (
        "target.distance_m",
        &["0.02", "0.05", "0.08", "0.09", "0.62", "0.65", "0.8", "0.96", "2", "6"],
    ),
    ("target.reflectance", &["0", "0.01", "0.03", "0.07", "0.65", "0.8", "0.95"]),
    ("ambient.irradiance_w_m2_nm", &["0.42", "0.6", "1", "5"]),
    ("firmware.shots_per_frame", &["300", "5000", "10000", "15000", "40000", "60000", "65535"]),
    ("laser.pulse_sigma_ps", &["20", "100", "200", "500"]),
    ("laser.average_power_w", &["0", "0.001", "0.02"]),
    ("laser.wavelength_nm", &["850"]),
    ("laser.field_of_illumination_deg", &["5", "40"]),
    ("lens.area_m2", &["0", "9.5e-6", "9.5e-4"]),
    ("lens.efficiency", &["0.4"]),
    ("filter.sigma_nm", &["1"]),
    ("filter.efficiency", &["0.2"]),
    ("spad.field_of_view_deg", &["5"]),
    ("spad.count", &["4"]),
    ("spad.pdp", &["0.0012", "0.12"]),
    ("spad.fill_factor", &["0.9"]),
    ("spad.dark_rate_hz", &["1e7"]),
    ("target.length_m", &["0.02"]),
    ("ambient.model", &["physical"]),
    ("pll.jitter_rms_ps", &["50"]),
    ("firmware.mode", &["1"]),
    ("firmware.laser_en", &["false"]),
    ("tdc.profile", &["ideal", "table6_3", "kintex7"]),
    ("tdc.calibration", &["uniform"]),
    ("firmware.laser_freq", &["0", "1", "2"]),
];

fn run(settings: &[String]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let mut args = vec!["run", "--json", "--fidelity", "shot", "--frames", FRAMES];
    settings.iter().for_each(|set| args.extend(["-s", set]));
    json(folder.path(), &args)
}

/// Mean error and its standard error [mm].
fn error_mm(run: &Value) -> Option<(f64, f64)> {
    let frames = run["frames"].as_array().unwrap();
    let error =
        |frame: &Value| Some(1e3 * (frame["depth_m"].as_f64()? - frame["true_depth_m"].as_f64()?));
    let errors: Option<Vec<f64>> = frames.iter().map(error).collect();
    let (errors, n) = (errors?, frames.len() as f64);
    let mean = errors.iter().sum::<f64>() / n;
    let variance = errors.iter().map(|error| (error - mean).powi(2)).sum::<f64>() / (n - 1.0);
    Some((mean, (variance / n).sqrt()))
}

#[test]
fn outside_of_any_limit_there_is_a_note_that_names_it_or_no_error() {
    let mut count = 0;
    for (key, values) in OUTSIDE {
        for value in *values {
            count += 1;
            let run = run(&[format!("{key}={value}")]);
            let notes = run["notes"].as_array().unwrap();
            let is_named = notes.iter().any(|note| note["key"] == *key);
            let is_right = error_mm(&run).is_some_and(|(mean, se)| mean.abs() < 1.0 + 3.0 * se);
            assert!(is_named || is_right, "{key}={value}: {notes:?} {:?}", error_mm(&run));
            assert!(is_named || notes.is_empty(), "{key}={value}: {notes:?}");
        }
    }
    assert!(count >= 60, "{count} scenarios");
}

#[test]
fn inside_of_all_limits_there_is_no_note() {
    let mut state = 1u64;
    let mut within = |low: f64, high: f64| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let part = (state >> 40) as f64 / (1u64 << 24) as f64;
        low + part * (high - low)
    };
    let folder = tempfile::tempdir().unwrap();
    for _ in 0..60 {
        let settings = [
            format!("target.distance_m={}", within(0.1, 0.6)),
            format!("target.reflectance={}", within(0.08, 0.6)),
            format!("ambient.irradiance_w_m2_nm={}", within(0.0, 0.4)),
            format!("firmware.laser_freq={}", within(0.0, 3.99) as u64),
            format!("seed={}", within(0.0, 1e9) as u64),
        ];
        let mut args = vec!["run", "--json", "--fidelity", "histogram", "--strict"];
        settings.iter().for_each(|set| args.extend(["-s", set]));
        let done = output(folder.path(), &args);
        let said = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success() && said.is_empty(), "{settings:?}: {said}");
        let run: Value = serde_json::from_slice(&done.stdout).unwrap();
        assert_eq!(run["notes"], serde_json::json!([]), "{settings:?}");
    }
}

#[test]
fn what_cannot_be_the_target_s_depth_has_no_true_depth_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    for (setting, code) in [
        ("target.distance_m=0.97", "echo-past-histogram"),
        ("firmware.laser_en=false", "no-light"),
        ("lens.area_m2=0", "no-light"),
    ] {
        let value = run(&[setting.to_owned()]);
        assert_eq!(value["notes"][0]["code"], code, "{setting}");
        assert!(value["frames"][0]["true_depth_m"].is_null(), "{setting}");
        let args = ["run", "--fidelity", "shot", "-s", setting];
        let table = stdout(folder.path(), &args);
        assert!(!table.contains("true depth") && !table.contains(" mm"), "{table}");
    }
    let run = json(folder.path(), &["run", "histogram_validation", "--waves", "none", "--json"]);
    assert_eq!(run["notes"][0]["code"], "no-light");
}

#[test]
fn strict_takes_a_note_for_an_error_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    let args =
        ["run", "--strict", "-s", "target.distance_m=0.65", "--frames", "100000", "-o", "out"];
    let error = refused(folder.path(), &args);
    assert!(
        error.contains("target.distance_m = 0.65") && error.contains("outside-training"),
        "{error}"
    );
    assert!(!folder.path().join("out").exists());
    stdout(folder.path(), &["run", "--strict", "--waves", "none"]);
}
