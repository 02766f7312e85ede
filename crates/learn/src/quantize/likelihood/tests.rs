//! Integers beside their twins.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use tofsim::optics::{BinProbabilities, Hazard};

use super::*;

/// A scenario and what is set.
type Scene = (&'static str, &'static [&'static str]);

/// Scenes of up to 20 photons a shot.
const SCENES: [Scene; 9] = [
    ("kc705", &[]),
    ("kc705", &["target.distance_m=0.1", "target.reflectance=0.08"]),
    ("kc705", &["target.distance_m=0.2", "target.reflectance=0.6"]),
    ("kc705", &["target.distance_m=0.6", "target.reflectance=0.08"]),
    ("kc705", &["target.distance_m=0.3", "ambient.irradiance_w_m2_nm=0.4"]),
    ("kc705", &["tdc.profile=table6_3", "target.distance_m=0.4"]),
    ("kc705", &["laser.pulse_sigma_ps=250", "firmware.shots_per_frame=5000"]),
    ("compact", &[]),
    ("fine", &[]),
];

/// Scenes of more, of which hardly a shot waits for the pulse's middle.
const BRIGHT: [Scene; 3] = [
    ("kc705", &["target.distance_m=0.08", "target.reflectance=0.6"]),
    ("kc705", &["target.distance_m=0.1", "ambient.irradiance_w_m2_nm=0"]),
    ("kc705", &["target.distance_m=0.1", "target.reflectance=0.6"]),
];

/// Explanations of some histograms of a scene.
fn explained(name: &str, set: &[&str]) -> Vec<ExplainedLikelihood> {
    let setup = Setup::load(name, set).unwrap();
    let explainer = LikelihoodExplainer::new(&setup).unwrap();
    let chances = BinProbabilities::new(&Hazard::new(&setup.budget), &setup.bins());
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let shots = setup.params.frame_ctrl.shots_per_frame.into();
    let mut drawn = || chances.draw(shots, &mut rng).into_iter().map(|count| count as u32);
    (0..20).map(|_| explainer.explain(&drawn().collect::<Vec<_>>())).collect()
}

fn of<'a>(all: &'a ExplainedLikelihood, stage: &str, value: &str, unit: &str) -> &'a StageValue {
    let is_it = |one: &&StageValue| one.stage == stage && one.value == value && one.unit == unit;
    all.values.iter().find(is_it).unwrap()
}

/// Demands that depths differ by less than that part of a deviation, and what else is found with them.
fn compare(scenes: &[Scene], most: f64) {
    for (name, set) in scenes {
        for (k, one) in explained(name, set).iter().enumerate() {
            let what = format!("{name} {set:?} {k}: {one:#?}");
            let off = |stage, value, unit| of(one, stage, value, unit).difference.abs();
            assert!(off("end", "depth", "m") < most * one.sigma_m, "{what}");
            assert!(off("end", "sigma", "mm") < 0.03 * 1e3 * one.sigma_m, "{what}");
            let signal = of(one, "step 6", "S", "photons");
            assert!(signal.difference.abs() < 0.1 * most * signal.float, "{what}");
            let chi_square = of(one, "end", "chi-square", "1");
            assert!(chi_square.difference.abs() < 0.1 * chi_square.float + 20.0 * most, "{what}");
            assert_eq!(one.status, one.status_float, "{what}");
        }
    }
}

#[test]
fn integers_lose_less_than_a_tenth_of_a_deviation() {
    compare(&SCENES, 0.1);
}

#[test]
fn they_lose_less_than_a_third_where_an_echo_uses_up_the_shots() {
    compare(&BRIGHT, 0.33);
}

#[test]
fn the_last_step_leads_to_the_depth() {
    for one in explained("kc705", &[]) {
        let [depth, last] = [("end", "depth"), ("step 6", "mu")].map(|(s, v)| of(&one, s, v, "m"));
        assert_eq!(depth.fixed, one.depth_m);
        assert!((depth.fixed - last.fixed).abs() < 1e-6, "{depth:?} {last:?}");
        assert_eq!(depth.float, last.float);
    }
}

#[test]
fn what_is_no_echo_is_none_for_both() {
    let setup = Setup::load("kc705", &[]).unwrap();
    let explainer = LikelihoodExplainer::new(&setup).unwrap();
    let lone = |bin: usize| (0..256).map(|k| if k == bin { 30_000 } else { 0 }).collect();
    let histograms: [Vec<u32>; 4] = [vec![0; 256], vec![100; 256], lone(0), vec![65_535; 256]];
    for histogram in histograms {
        let one = explainer.explain(&histogram);
        let words = (&one.status, &one.status_float);
        assert!(!one.status.is_empty() && !one.status_float.is_empty(), "{words:?}");
        let finite = |of: &StageValue| of.fixed.is_finite() && of.float.is_finite();
        assert!(one.values.iter().all(finite), "{one:#?}");
    }
}

#[test]
fn a_scenario_without_the_estimator_is_refused() {
    let setup = Setup::load("kc705", &["firmware.mode=1"]).unwrap();
    let fault = LikelihoodExplainer::new(&setup).unwrap_err().to_string();
    assert!(fault.contains("firmware.mode = 1: expected 0 for likelihood_estimator"), "{fault}");
}
