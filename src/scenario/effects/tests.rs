use super::*;
use crate::scenario::{Control, QuenchMode, Shape};

fn with(change: impl FnOnce(&mut Scenario)) -> Scenario {
    let mut scenario = Scenario::default();
    change(&mut scenario);
    scenario
}

fn found(scenario: &Scenario, method: Method) -> Vec<(&'static str, String, String)> {
    let obstacles = scenario.obstacles(method);
    obstacles.map(|one| (one.key, one.value.to_string(), one.expected())).collect()
}

fn one(key: &'static str, value: &str, expected: &str) -> Vec<(&'static str, String, String)> {
    vec![(key, value.to_owned(), expected.to_owned())]
}

#[test]
fn a_scenario_of_defaults_has_no_effect() {
    for effect in Effect::ALL {
        assert_eq!(effect.occurrence(&Scenario::default()), None, "{effect:?}");
        assert!(
            !effect.keys().is_empty() && !effect.why().is_empty() && !effect.meaning().is_empty()
        );
    }
}

#[test]
fn an_effect_is_found_by_its_key_until_it_is_switched_off() {
    let both = |s: &mut Scenario| (s.spad.pulse_gap_ns, s.laser.energy_jitter) = (10.0, 0.1);
    let mut scenario = with(both);
    assert_eq!(found(&scenario, Method::FastForward), one("spad.pulse_gap_ns", "10", "0"));
    assert_eq!(found(&scenario, Method::CramerRaoBound), one("laser.energy_jitter", "0.1", "0"));
    assert_eq!(found(&scenario, Method::Matched).len(), 2);
    Effect::PulseShaping.switch_off(&mut scenario);
    assert_eq!(found(&scenario, Method::FastForward), []);
    Effect::LaserEnergy.switch_off(&mut scenario);
    assert_eq!(scenario, Scenario::default());
}

#[test]
fn a_search_accepts_a_little_jitter_and_a_model_none() {
    let jitter = |ps| with(|s| s.pll.jitter_rms_ps = ps);
    assert_eq!(found(&jitter(20.0), Method::Centroid), []);
    let expected = one("pll.jitter_rms_ps", "20.5", "20 at most");
    assert_eq!(found(&jitter(20.5), Method::Centroid), expected);
    assert_eq!(found(&jitter(0.5), Method::Matched), one("pll.jitter_rms_ps", "0.5", "0"));
    assert_eq!(found(&jitter(50.0), Method::Likelihood), []);
}

#[test]
fn a_method_has_the_obstacles_of_what_it_is_built_on() {
    let afterpulses = with(|s| s.spad.afterpulse_probability = 0.001);
    for method in [Method::HistogramDraw, Method::IndependentShots, Method::SecondOpinion] {
        let expected = one("spad.afterpulse_probability", "0.001", "0");
        assert_eq!(found(&afterpulses, method), expected, "{method:?}");
    }
}

#[test]
fn some_effects_need_more_than_their_key() {
    let crosstalk = |row_outputs| {
        with(|s| (s.spad.crosstalk_probability, s.spad.row_outputs) = (0.1, row_outputs))
    };
    assert_eq!(found(&crosstalk(0), Method::HistogramDraw), []);
    let expected = one("spad.crosstalk_probability", "0.1", "0");
    assert_eq!(found(&crosstalk(30), Method::HistogramDraw), expected);
    let shared = with(|s| (s.spad.on_tdc, s.firmware.mode) = (2, QuenchMode::FreeRunning));
    assert_eq!(found(&shared, Method::Likelihood), one("spad.on_tdc", "2", "1"));
    assert_eq!(found(&with(|s| s.spad.on_tdc = 2), Method::Likelihood), []);
}

#[test]
fn a_list_is_shown_by_its_length_and_a_file_by_its_name() {
    let control = with(|s| s.control = vec![Control::default(); 2]);
    assert_eq!(found(&control, Method::SeparateFrames), one("control", "2", "0"));
    let conditions = with(|s| s.tdc.conditions = Some("heat.csv".into()));
    let expected = one("tdc.conditions", "heat.csv", "none");
    assert_eq!(found(&conditions, Method::SeparateFrames), expected);
}

#[test]
fn the_key_that_makes_more_than_one_echo_is_named() {
    let key = |change: &dyn Fn(&mut Scenario)| {
        let effect = with(change).complex_scene();
        effect.map(|effect| (effect.key, effect.value.to_string()))
    };
    let named = |key: &'static str, value: &str| Some((key, value.to_owned()));
    assert_eq!(key(&|s| s.target.radius_m = 7.0), None);
    assert_eq!(key(&|s| s.target.shape = Shape::Sphere), named("target.shape", "sphere"));
    assert_eq!(key(&|s| s.target.extended = true), named("target.extended", "true"));
    assert_eq!(key(&|s| s.target.yaw_deg = -3.0), named("target.yaw_deg", "-3"));
    assert_eq!(key(&|s| s.target.retro_side_m = 0.1), named("target.retro_side_m", "0.1"));
    let fog = |s: &mut Scenario| s.atmosphere.visibility_m = 50.0;
    assert_eq!(key(&fog), named("atmosphere.visibility_m", "50"));
    let rain = |s: &mut Scenario| s.atmosphere.rain_mm_h = 5.0;
    assert_eq!(key(&rain), named("atmosphere.rain_mm_h", "5"));
}

#[test]
fn a_template_of_the_window_leaves_the_methods_valid_that_take_it() {
    let behind = |file: Option<&str>| {
        with(|s| (s.cover.fraction, s.estimator.glass_file) = (1e-4, file.map(Into::into)))
    };
    let (without, with_template) = (behind(None), behind(Some("glass.csv")));
    let taking = [
        Method::CramerRaoBound,
        Method::SecondOpinion,
        Method::Likelihood,
        Method::TwoEchoes,
        Method::LikelihoodEstimator,
        Method::Matched,
    ];
    for method in taking {
        assert_eq!(found(&without, method)[0].0, "cover.fraction", "{method:?}");
        assert_eq!(found(&with_template, method), [], "{method:?}");
    }
    for method in [Method::Centroid, Method::Peak] {
        assert_eq!(found(&with_template, method), found(&without, method), "{method:?}");
    }
    let two = with(|s| s.target.second_share = 0.5);
    assert_eq!(found(&two, Method::CramerRaoBound), []);
    assert_eq!(found(&two, Method::Likelihood).len(), 1);
}
