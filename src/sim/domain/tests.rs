//! Tests of the keys that are noted, and of those that do not concern a network.

use super::*;
use crate::firmware::tdc_decoder::Decoder;
use crate::scenario::{self, Shape, TdcCalibration, VisibilityModel, builtin};

const THESIS: [GridRange; 3] = [
    ("target.distance_m", [0.1, 0.6]),
    ("target.reflectance", [0.08, 0.6]),
    ("ambient.irradiance_w_m2_nm", [0.0, 0.4]),
];

fn network() -> Network {
    Network::builtin("uniform").unwrap().unwrap()
}

fn keys(change: impl FnOnce(&mut Scenario)) -> Vec<String> {
    let mut scenario = Scenario::default();
    change(&mut scenario);
    let notes = notes(&network(), &scenario, &[]).unwrap();
    assert!(notes.iter().all(|note| note.code == NoteCode::OutsideTraining));
    notes.into_iter().map(|note| note.key).collect()
}

#[test]
fn the_shipped_files_state_the_domain_of_their_training() {
    for name in Network::builtin_names() {
        let network = Network::builtin(name).unwrap().unwrap();
        if builtin::scenario(name).is_some() {
            let scenario = scenario::load(name, &[]).unwrap().scenario;
            assert!(network.domain.is_some(), "{name}");
            assert_eq!(notes(&network, &scenario, &[]).unwrap(), [], "{name}");
            continue;
        }
        let mut scenario = Scenario::default();
        scenario.tdc.profile = network.training.chain.clone();
        assert_eq!(network.domain, Some(of(&scenario, &THESIS).unwrap()), "{name}");
    }
}

#[test]
fn each_thing_that_the_network_was_not_trained_for_is_named() {
    assert_eq!(keys(|_| {}), [""; 0]);
    assert_eq!(keys(|s| s.target.distance_m = 0.65), ["target.distance_m"]);
    assert_eq!(keys(|s| s.target.reflectance = 0.03), ["target.reflectance"]);
    assert_eq!(keys(|s| s.firmware.shots_per_frame = 10_000), ["firmware.shots_per_frame"]);
    assert_eq!(keys(|s| s.firmware.dark_frames = true), ["firmware.shots_per_frame"]);
    assert_eq!(keys(|s| s.lens.area_m2 *= 10.0), ["lens.area_m2"]);
    assert_eq!(keys(|s| s.tdc.profile = "ideal".into()), ["tdc.profile"]);
    assert_eq!(keys(|s| s.tdc.calibration = TdcCalibration::Uniform), ["tdc.calibration"]);
    assert_eq!(keys(|s| s.tdc.decoder = Decoder::Leading), ["tdc.decoder"]);
    assert_eq!(keys(|s| s.spad.dark_rate_hz = 0.0), [""; 0]);
    assert_eq!(keys(|s| s.pll.output_divide = 10), ["pll.clk_sys_mhz"]);
    assert_eq!(keys(|s| (s.pll.divide, s.pll.output_divide) = (2, 4)), [""; 0]);
    assert_eq!(keys(|s| s.firmware.laser_freq = 0), [""; 0]);
    assert_eq!(keys(|s| s.spad.temperature_c = 60.0), ["spad.temperature_c"]);
    // What the dark rate and the delays change by decides nothing where they do not change.
    assert_eq!(keys(|s| s.spad.dark_doubling_c = 10.0), [""; 0]);
    assert_eq!(keys(|s| (s.tdc.delay_per_c, s.tdc.delay_per_mv) = (0.002, 0.0)), [""; 0]);
    let warm = |s: &mut Scenario| (s.spad.temperature_c, s.spad.dark_doubling_c) = (60.0, 10.0);
    assert_eq!(keys(warm), ["spad.dark_doubling_c", "spad.temperature_c"]);
    assert_eq!(keys(|s| s.laser.delay_ps = 500.0), ["laser.delay_ps"]);
    let afterpulses = |s: &mut Scenario| s.spad.afterpulse_probability = 0.01;
    assert_eq!(keys(afterpulses), ["spad.afterpulse_probability"]);
    assert_eq!(keys(|s| s.target.shape = Shape::Step), ["target.shape"]);
    assert_eq!(keys(|s| s.target.extended = true), ["target.extended"]);
    assert_eq!(keys(|s| s.target.tilt_deg = 5.0), ["target.tilt_deg"]);
    assert_eq!(keys(|s| s.atmosphere.visibility_m = 50.0), ["atmosphere.visibility_m"]);
    assert_eq!(keys(|s| s.atmosphere.rain_mm_h = 5.0), ["atmosphere.rain_mm_h"]);
    // What only other shapes have, or fog, decides nothing.
    assert_eq!(keys(|s| (s.target.radius_m, s.atmosphere.airlight) = (0.3, 0.0)), [""; 0]);
    let mode = |s: &mut Scenario| s.firmware.mode = crate::scenario::QuenchMode::FreeRunning;
    assert_eq!(keys(mode), ["firmware.mode"]);
}

#[test]
fn a_calibration_is_a_word_of_the_domain_and_older_files_know_one_only() {
    let mut scenario = Scenario::default();
    assert!(!of(&scenario, &[]).unwrap().words.contains_key("tdc.calibration"));
    scenario.tdc.calibration = TdcCalibration::Uniform;
    let uniform = of(&scenario, &THESIS).unwrap();
    assert_eq!(uniform.words["tdc.calibration"], "uniform");
    let network = Network { domain: Some(uniform), ..network() };
    assert_eq!(notes(&network, &scenario, &[]).unwrap(), []);
    let found = notes(&network, &Scenario::default(), &[]).unwrap();
    assert_eq!((found.len(), found[0].key.as_str()), (1, "tdc.calibration"));
    assert_eq!((found[0].value.to_string(), &found[0].expected[..]), ("true".into(), "uniform"));
}

#[test]
fn what_dark_rate_and_delays_change_by_is_of_the_domain_of_other_conditions() {
    let mut trained = Scenario::default();
    (trained.spad.temperature_c, trained.tdc.temperature_c) = (60.0, 45.0);
    let mut domain = of(&trained, &[]).unwrap();
    assert_eq!(domain.ranges["spad.dark_doubling_c"], [8.0, 8.0]);
    let own = Network { domain: Some(domain.clone()), ..network() };
    domain.ranges.retain(|key, _| !["spad.dark_doubling_c", "tdc.delay_per_c"].contains(&&**key));
    let older = Network { domain: Some(domain), ..network() };
    for network in [own, older] {
        let keys = |change: &dyn Fn(&mut Scenario), grid: &[GridRange]| {
            let mut scenario = trained.clone();
            change(&mut scenario);
            let notes = notes(&network, &scenario, grid).unwrap();
            notes.into_iter().map(|note| note.key).collect::<Vec<_>>()
        };
        assert_eq!(keys(&|_| (), &[]), [""; 0]);
        assert_eq!(keys(&|s| s.spad.dark_doubling_c = 9.0, &[]), ["spad.dark_doubling_c"]);
        assert_eq!(keys(&|s| s.tdc.delay_per_c = 0.002, &[]), ["tdc.delay_per_c"]);
        assert_eq!(keys(&|s| s.tdc.delay_per_mv = 0.0, &[]), [""; 0]);
        let back = |s: &mut Scenario| (s.spad.temperature_c, s.spad.dark_doubling_c) = (20.0, 9.0);
        assert_eq!(keys(&back, &[]), ["spad.temperature_c"]);
        let grid = [("spad.temperature_c", [20.0, 60.0])];
        let over = keys(&|s| s.spad.dark_doubling_c = 9.0, &grid);
        assert!(over.contains(&"spad.dark_doubling_c".to_owned()), "{over:?}");
    }
}

#[test]
fn what_shape_and_fog_were_trained_with_is_of_the_domain() {
    let mut trained = Scenario::default();
    (trained.target.shape, trained.atmosphere.visibility_m) = (Shape::Sphere, 50.0);
    let domain = of(&trained, &[]).unwrap();
    assert_eq!(domain.words["target.shape"], "sphere");
    assert_eq!(domain.ranges["target.radius_m"], [0.1; 2]);
    assert_eq!(domain.words["atmosphere.visibility_model"], "kim");
    assert!(!domain.ranges.contains_key("target.edge_m"));
    assert!(!domain.ranges.contains_key("atmosphere.rain_db_km"));
    let network = Network { domain: Some(domain), ..network() };
    let keys = |change: &dyn Fn(&mut Scenario)| {
        let mut scenario = trained.clone();
        change(&mut scenario);
        let notes = notes(&network, &scenario, &[]).unwrap();
        notes.into_iter().map(|note| note.key).collect::<Vec<_>>()
    };
    assert_eq!(keys(&|_| ()), [""; 0]);
    assert_eq!(keys(&|s| s.target.radius_m = 0.2), ["target.radius_m"]);
    assert_eq!(keys(&|s| s.target.shape = Shape::Disc), ["target.shape"]);
    assert_eq!(keys(&|s| s.atmosphere.airlight = 0.0), ["atmosphere.airlight"]);
    let kruse = |s: &mut Scenario| s.atmosphere.visibility_model = VisibilityModel::Kruse;
    assert_eq!(keys(&kruse), ["atmosphere.visibility_model"]);
    let fogs = [("atmosphere.visibility_m", [0.0, 100.0])];
    assert!(of(&Scenario::default(), &fogs).unwrap().ranges.contains_key("atmosphere.overlap_m"));
}

#[test]
fn a_grid_is_held_to_the_domain_as_a_whole() {
    let (network, scenario) = (network(), Scenario::default());
    assert_eq!(notes(&network, &scenario, &THESIS).unwrap(), []);
    let wide = [("target.distance_m", [0.05, 0.6])];
    let notes = notes(&network, &scenario, &wide).unwrap();
    assert_eq!(notes.len(), 1);
    assert_eq!(notes[0].value, NoteValue::Text("0.05 to 0.6".to_owned()));
    assert_eq!(notes[0].expected, "0.1 to 0.6");
    assert!(of(&scenario, &[("target.distance", [0.0, 1.0])]).is_err());
}

#[test]
fn a_file_that_does_not_say_is_said_to_be_silent() {
    let silent = Network { domain: None, ..network() };
    let notes = notes(&silent, &Scenario::default(), &[]).unwrap();
    assert_eq!(notes.len(), 1);
    assert_eq!(notes[0].key, "estimator.network");
}
