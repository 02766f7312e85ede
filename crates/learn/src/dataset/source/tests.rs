use super::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::io::Write;
use tofsim::kernel::Time;
use tofsim::scenario;

fn source(overrides: &[&str]) -> Result<HistogramSource> {
    let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
    HistogramSource::new(&Setup::new(scenario::load("kc705", &overrides)?)?)
}

const SCENE: Scene =
    Scene { distance_m: 0.3, reflectance: 0.34, irradiance_w_m2_nm: 0.2, setting: 0, pixel: 0 };

#[test]
fn the_bins_of_the_ideal_chain_are_those_of_the_thesis() {
    let source = source(&["tdc.profile=ideal"]).unwrap();
    let spans = source.bins().spans();
    assert_eq!(spans.len(), 256);
    // An avalanche on a tap's border is seen by that tap: bins begin a femtosecond late.
    let edge = |k: usize| Time::from_fs(25_000 * k as u64 + u64::from(k > 0));
    for (k, span) in spans.iter().enumerate() {
        assert_eq!((span.from, span.until, span.code), (edge(k), edge(k + 1), k as u16));
    }
}

#[test]
fn the_mean_histogram_has_the_probabilities() {
    let source = source(&[]).unwrap();
    let codes = source.probabilities(&SCENE);
    let rows = 400;
    let mut sums = [0u64; 256];
    for row in 0..rows {
        let histogram = source.draw_from(&codes, &SCENE, 5, row);
        sums.iter_mut().zip(histogram).for_each(|(sum, count)| *sum += u64::from(count));
    }
    let shots = f64::from(source.shots()) * rows as f64;
    let missed = shots - sums.iter().sum::<u64>() as f64;
    let expected_missed = shots * (1.0 - codes.of_code().iter().sum::<f64>());
    let cells = sums.iter().zip(codes.of_code()).map(|(&sum, p)| (sum as f64, shots * p));
    let cells = cells.chain([(missed, expected_missed)]).filter(|cell| cell.1 >= 5.0);
    let term = |(found, expected): (f64, f64)| (found - expected).powi(2) / expected;
    let chi2: f64 = cells.clone().map(term).sum();
    let freedom = cells.count() as f64 - 1.0;
    let level = 1.0 - ChiSquared::new(freedom).unwrap().cdf(chi2);
    assert!(level > 0.001, "chi2 {chi2} of {freedom}, level {level}");
}

#[test]
fn rows_vary_as_independent_multinomial_draws_do() {
    let source = source(&["firmware.shots_per_frame=5000"]).unwrap();
    let codes = source.probabilities(&SCENE);
    let (mut chi2, mut freedom) = (0.0, 0.0);
    for row in 0..200 {
        for (&count, p) in source.draw_from(&codes, &SCENE, 1, row).iter().zip(codes.of_code()) {
            let expected = 5000.0 * p;
            if expected >= 5.0 {
                chi2 += (f64::from(count) - expected).powi(2) / (expected * (1.0 - p));
                freedom += 1.0;
            }
        }
    }
    // Bins of a row hardly depend on one another; 4.5 sigma of chi2.
    let deviation = (chi2 - freedom) / (2.0 * freedom).sqrt();
    assert!(deviation.abs() < 4.5, "chi2 {chi2} of {freedom}");
}

#[test]
fn a_scene_is_what_the_scenario_with_its_values_gives() {
    let other = source(&["target.distance_m=0.1", "ambient.irradiance_w_m2_nm=0"]).unwrap();
    let own = source(&["target.distance_m=0.3"]).unwrap();
    assert_eq!(other.probabilities(&SCENE), own.probabilities(&SCENE));
    let dark = source(&["firmware.laser_en=false"]).unwrap().probabilities(&SCENE);
    assert!(dark.of_code()[80] < 0.5 * own.probabilities(&SCENE).of_code()[80]);
}

#[test]
fn the_budget_is_that_of_the_scenario_in_either_ambient_model() {
    for model in ["fitted", "physical"] {
        let mut scenario = source(&[&format!("ambient.model={model}")]).unwrap().scenario().clone();
        scenario.target.distance_m = 0.6;
        scenario.target.reflectance = 0.37;
        scenario.ambient.irradiance_w_m2_nm = 0.35;
        let expected = Budget::new(&scenario, Pulse::default());
        let scene = Scene { distance_m: 0.6, reflectance: 0.37, irradiance_w_m2_nm: 0.35, ..SCENE };
        let source = source(&[&format!("ambient.model={model}")]).unwrap();
        let found = scaled(&source.white(&scene), &scene);
        let close = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-14;
        assert!(close(found.signal_per_shot, expected.signal_per_shot), "{found:?}");
        assert!(close(found.ambient_rate_hz, expected.ambient_rate_hz), "{found:?}");
        let Budget { signal_per_shot, ambient_rate_hz, .. } = expected;
        assert_eq!(Budget { signal_per_shot, ambient_rate_hz, ..found }, expected);
    }
}

#[test]
fn measured_dark_rates_are_those_of_every_scene() {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    writeln!(file, "row,output,rate_hz\n0,15,7000").unwrap();
    let key = format!("spad.dark_file={}", file.path().display());
    assert_eq!(source(&[&key]).unwrap().white(&SCENE).dark_rate_hz, 7000.0);
}

#[test]
fn a_histogram_never_has_more_counts_than_shots() {
    let source = source(&["firmware.shots_per_frame=65535", "spad.pdp=1"]).unwrap();
    let near = Scene { distance_m: 0.001, reflectance: 1.0, irradiance_w_m2_nm: 100.0, ..SCENE };
    let histogram = source.draw_from(&source.probabilities(&near), &near, 1, 0);
    assert_eq!(histogram.iter().map(|&count| u64::from(count)).sum::<u64>(), 65_535);
    assert_eq!(histogram[0], 65_535);
}

#[test]
fn each_setting_has_its_own_optics_chain_and_shots() {
    let of = |keys: &[&str]| {
        let keys: Vec<_> = keys.iter().map(|&key| key.to_owned()).collect();
        Setup::new(scenario::load("kc705", &keys).unwrap()).unwrap()
    };
    let wide = ["laser.pulse_sigma_ps=200", "tdc.profile=ideal", "firmware.shots_per_frame=500"];
    let both = HistogramSource::of_settings(&[of(&[]), of(&wide)]).unwrap();
    for (setting, keys) in [&[][..], &wide].into_iter().enumerate() {
        let (alone, scene) = (source(keys).unwrap(), Scene { setting, ..SCENE });
        let codes = both.probabilities(&scene);
        assert_eq!(codes, alone.probabilities(&SCENE));
        let drawn = both.draw_from(&codes, &scene, 1, 7);
        assert_eq!(drawn, alone.draw_from(&codes, &SCENE, 1, 7));
    }
    assert!(HistogramSource::of_settings(&[]).is_err());
}

#[test]
fn what_has_no_closed_form_is_refused() {
    let refused = |set: &str| source(&[set]).unwrap_err().to_string();
    let error = refused("firmware.mode=1");
    assert!(
        error.starts_with("scenario kc705: firmware.mode = 1: expected 0 for a dataset"),
        "{error}"
    );
    assert!(refused("pll.jitter_rms_ps=7.7").contains("pll.jitter_rms_ps = 7.7"));
    assert!(refused("firmware.rst=true").contains("firmware.rst = true"));
}

#[test]
fn what_air_and_patch_send_back_does_not_go_with_the_reflectance() {
    let keys = ["atmosphere.visibility_m=10", "target.retro_side_m=0.01"];
    let source = source(&keys).unwrap();
    for reflectance in [0.05, 0.8] {
        let scene = Scene { reflectance, ..SCENE };
        let mut scenario = source.scenario().clone();
        scenario.target.distance_m = scene.distance_m;
        scenario.target.reflectance = scene.reflectance;
        scenario.ambient.irradiance_w_m2_nm = scene.irradiance_w_m2_nm;
        let expected = Budget::new(&scenario, Pulse::default());
        let found = scaled(&source.white(&scene), &scene);
        assert!(found.backscatter_per_shot > 0.0 && found.retro_per_shot > 0.0);
        for (found, expected) in [
            (found.signal_per_shot, expected.signal_per_shot),
            (found.retro_per_shot, expected.retro_per_shot),
            (found.backscatter_per_shot, expected.backscatter_per_shot),
            (found.ambient_rate_hz, expected.ambient_rate_hz),
            (found.airlight_rate_hz, expected.airlight_rate_hz),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        }
        assert_eq!(found.spread, expected.spread);
    }
}

#[test]
fn pixels_have_the_probabilities_of_their_setups() {
    let own = ["tdc.profile=kintex7", "array.chains_file=../chains/columns.csv"];
    for more in [&[][..], &own] {
        let keys = ["array.rows=2", "array.columns=3", "target.length_m=0.5", "target.tilt_deg=35"];
        let keys: Vec<_> = keys.iter().chain(more).map(|&key| key.to_owned()).collect();
        let array = Arc::new(ArraySetup::new(scenario::load("kc705", &keys).unwrap()).unwrap());
        let source = HistogramSource::of_arrays(std::slice::from_ref(&array)).unwrap();
        let keys = &array.common().scenario;
        for pixel in 0..6 {
            let setup = array.pixel(pixel / 3, pixel % 3);
            let scene = Scene {
                distance_m: setup.mean_radial_m().unwrap(),
                reflectance: keys.target.reflectance,
                irradiance_w_m2_nm: keys.ambient.irradiance_w_m2_nm,
                setting: 0,
                pixel,
            };
            let expected = BinProbabilities::new(&Hazard::new(&setup.budget), &setup.bins());
            let found = source.probabilities(&scene);
            for (found, expected) in found.of_code().iter().zip(expected.of_code()) {
                assert!((found - expected).abs() < 1e-12, "{pixel}: {found} for {expected}");
            }
            assert_eq!(*source.acquisition_of(&scene).bins, setup.known_bins(), "{pixel}");
        }
    }
}
