//! `estimate` of a histogram that two surfaces have made.

use tofsim::sim::setup::Setup;

use crate::common::{csv, empty, json, stdout};

/// Photons a shot of each surface, and where they are [m].
const SURFACES: [(f64, f64); 2] = [(0.3, 0.35), (0.5, 0.2)];
/// Time of a metre there and back [ps].
const PS_PER_M: f64 = 2e12 / 299_792_458.0;
/// Standard deviation of the pulse [ps], and ambient photons [1/ps].
const SIGMA_PS: f64 = 137.0;
const AMBIENT: f64 = 2e-5;

/// Part of a standard Gaussian below `x`, by Simpson's rule.
fn below(x: f64) -> f64 {
    let density = |t: f64| (-0.5 * t * t).exp() / std::f64::consts::TAU.sqrt();
    let (from, steps) = (-8.0, 2000);
    let step = (x.clamp(from, 8.0) - from) / f64::from(steps);
    let weight = |k: i32| match k {
        0 => 1.0,
        k if k == steps => 1.0,
        k if k % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=steps).map(|k| weight(k) * density(from + f64::from(k) * step)).sum::<f64>() * step / 3.0
}

/// Returns the expected histogram of 30,000 shots, counting the first photon of each.
fn histogram(surfaces: &[(f64, f64)]) -> Vec<u32> {
    let setup = Setup::load("kc705", &[]).unwrap();
    let edges = setup.known_bins().edges_ps().to_vec();
    let mut waiting = 30_000.0;
    let count = |edge: &[f64]| {
        let of = |(distance_m, signal): &(f64, f64)| {
            let part = |ps: f64| below((ps - distance_m * PS_PER_M) / SIGMA_PS);
            signal * (part(edge[1]) - part(edge[0]))
        };
        let hazard = surfaces.iter().map(of).sum::<f64>() + AMBIENT * (edge[1] - edge[0]);
        let hits = waiting * (1.0 - (-hazard).exp());
        waiting -= hits;
        hits.round() as u32
    };
    edges.windows(2).map(count).collect()
}

#[test]
fn both_surfaces_are_found_where_the_firmware_names_another_echo() {
    let folder = empty();
    std::fs::write(folder.path().join("two.csv"), csv(&histogram(&SURFACES))).unwrap();
    let asked = ["estimate", "two.csv", "--estimator", "two-echoes,likelihood_estimator"];
    let report = json(folder.path(), &[&asked[..], &["--json"]].concat());
    let [both, firmware] = [0, 1].map(|k| &report["histograms"][0]["estimates"][k]);
    assert_eq!(firmware["failure"], "another echo");
    for (found, (distance_m, _)) in [both, &both["second"]].into_iter().zip(SURFACES) {
        let [depth_m, sigma_m] = ["depth_m", "sigma_m"].map(|key| found[key].as_f64().unwrap());
        assert!((depth_m - distance_m).abs() < 1e-4, "{depth_m} m is not {distance_m} m");
        assert!((1e-4..1e-3).contains(&sigma_m), "{sigma_m} m");
    }
    let table = stdout(folder.path(), &asked);
    let metres = |found: &serde_json::Value| format!("{:.6}", found["depth_m"].as_f64().unwrap());
    let cell = format!("{} and {}", metres(both), metres(&both["second"]));
    assert!(table.contains(&cell), "{table}");
}

#[test]
fn one_surface_has_the_depth_of_likelihood_and_no_second() {
    let folder = empty();
    std::fs::write(folder.path().join("one.csv"), csv(&histogram(&SURFACES[..1]))).unwrap();
    let asked = ["estimate", "one.csv", "--estimator", "two-echoes,likelihood", "--json"];
    let report = json(folder.path(), &asked);
    let [both, one] = [0, 1].map(|k| &report["histograms"][0]["estimates"][k]);
    assert!(both.get("second").is_none());
    assert_eq!((&both["depth_m"], &both["sigma_m"]), (&one["depth_m"], &one["sigma_m"]));
}
