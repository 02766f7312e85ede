//! A drift against a reckoning by hand, and against a calibration that follows.

use tofsim::error::Error;
use tofsim::optics::budget::LIGHT_M_S;
use tofsim::scenario;

use super::*;

fn loaded(set: &[&str]) -> Loaded {
    let set: Vec<_> = set.iter().map(|text| (*text).to_owned()).collect();
    scenario::load("kc705", &set).unwrap()
}

fn drift(profile: &Profile, every_s: f64, repeats: u64) -> Drift {
    let plan = Plan { kind: EstimatorKind::Likelihood, every_s, repeats };
    let near = ["target.distance_m=0.3", "ambient.irradiance_w_m2_nm=0.05"];
    Drift::new(&loaded(&near), profile, plan, None, |_| {}).unwrap()
}

/// By how much a depth grows, with ages that were right before delays grew by a part of themselves. A hit is
/// sampled at the first edge at which it has reached tap 0; its age is read as that of the unstretched chain.
fn expected_mm(setup: &Setup, factor: f64) -> f64 {
    let cycle_ps = setup.cycle().fs() as f64 * 1e-3;
    let delays = &setup.params.tdc.delays;
    let [tap_0_ps, arrival_ps] =
        [delays.tap_0(), setup.budget.mean_arrival].map(|t| t.fs() as f64 * 1e-3);
    // The first edge after the arrival at which tap 0 has been reached.
    let edge = ((arrival_ps + factor * tap_0_ps) / cycle_ps).ceil();
    let age_ps = edge * cycle_ps - arrival_ps;
    // As many taps as an age of so much less would have reached before.
    (age_ps - age_ps / factor) * 1e-12 * LIGHT_M_S / 2.0 * 1e3
}

#[test]
fn a_drift_moves_the_depth_by_the_age_s_part_and_a_calibration_takes_it_back() {
    let profile = Profile::ramp(25.0, 27.0, 100.0, 3, 0.0);
    let found = drift(&profile, 50.0, 40);
    let setup = Setup::load("kc705", &["target.distance_m=0.3"]).unwrap();
    for point in &found.points {
        let factor = 1.0 + 0.001 * (point.moment.temperature_c - 25.0);
        let [once, repeated] = [&point.once, &point.repeated];
        let expected = expected_mm(&setup, factor);
        let (mean, se) = (once.mean_mm.unwrap(), once.mean_se_mm.unwrap());
        assert!((mean - expected).abs() < 4.0 * se + 0.05, "{mean} +- {se}, expected {expected}");
        // Calibrated in the very moment.
        assert_eq!(point.calibrated_s, point.moment.time_s);
        assert!(repeated.mean_mm.unwrap().abs() < 4.0 * repeated.mean_se_mm.unwrap() + 0.05);
    }
    assert_eq!(found.points[0].once, found.points[0].repeated);
    assert!(found.points[2].once.mean_mm.unwrap() > 1.0);
}

#[test]
fn the_last_calibration_is_that_of_the_last_whole_interval() {
    let profile = Profile::ramp(25.0, 25.2, 100.0, 5, 0.0);
    let found = drift(&profile, 60.0, 2);
    let calibrated: Vec<_> = found.points.iter().map(|point| point.calibrated_s).collect();
    assert_eq!(calibrated, [0.0, 0.0, 0.0, 60.0, 60.0]);
}

#[test]
fn what_cannot_be_drawn_or_estimated_is_refused() {
    let profile = Profile::ramp(25.0, 30.0, 10.0, 2, 0.0);
    let error = |set: &[&str], kind| {
        let plan = Plan { kind, every_s: 1.0, repeats: 2 };
        Drift::new(&loaded(set), &profile, plan, None, |_| {}).unwrap_err().to_string()
    };
    assert!(error(&[], EstimatorKind::Subtraction).contains("no dark histograms"));
    assert!(error(&["firmware.mode=1"], EstimatorKind::Peak).contains("firmware.mode"));
    let stopped = AtomicBool::new(true);
    let plan = Plan { kind: EstimatorKind::Peak, every_s: 1.0, repeats: 2 };
    let stopped = Drift::new(&loaded(&[]), &profile, plan, Some(&stopped), |_| {});
    assert!(matches!(stopped, Err(Error::Interrupted)));
}
