//! Tests of the limits that notes of a setup name.

use super::*;

#[test]
fn an_echo_after_the_next_pulse_is_said_not_to_be_simulated() {
    let text = |distance_m: &str| {
        let wall = ["target.length_m=10", "target.width_m=10", distance_m];
        let setup = Setup::load("kc705", &wall).unwrap();
        setup.no_depth().map(|note| (note.code, note.text.contains("after the next pulse")))
    };
    // The laser's period is 48 ns, 7.19 m.
    assert_eq!(text("target.distance_m=0.9"), None);
    assert_eq!(text("target.distance_m=7.1"), Some((NoteCode::EchoPastHistogram, false)));
    assert_eq!(text("target.distance_m=7.3"), Some((NoteCode::EchoPastHistogram, true)));
}

#[test]
fn a_target_of_which_a_part_is_too_far_is_noted() {
    let notes = |set: &[&str]| {
        let set = [&["estimator.kind=centroid"], set].concat();
        let notes = Setup::load("kc705", &set).unwrap().notes().unwrap();
        notes.into_iter().map(|note| (note.code, note.key)).collect::<Vec<_>>()
    };
    let step = ["target.shape=step", "target.second_distance_m=1.5"];
    let past = |key: &str| vec![(NoteCode::EchoPastHistogram, key.to_owned())];
    assert_eq!(notes(&step), past("target.second_distance_m"));
    assert_eq!(notes(&step[..1]), []);
    let both = [&step[..], &["target.distance_m=1.2"]].concat();
    assert_eq!(notes(&both), past("target.distance_m"));
    let beside = notes(&["target.offset_x_m=9"]);
    assert_eq!(beside, [(NoteCode::NoLight, "target.offset_x_m".to_owned())]);
}

#[test]
fn a_chain_that_has_drifted_is_noted_with_its_cause_and_by_how_much() {
    let notes = |overrides: &[&str]| {
        let set = [&["estimator.kind=centroid"], overrides].concat();
        let notes = Setup::load("kc705", &set).unwrap().notes().unwrap();
        notes.into_iter().map(|note| note.to_string()).collect::<Vec<_>>()
    };
    assert!(notes(&["tdc.temperature_c=65", "tdc.supply_mv=10"]).is_empty(), "calibrated now");
    // 8 ns look like 8 ns / 1.04.
    let warm = notes(&["tdc.temperature_c=65", "tdc.calibrated_at_c=25"]);
    assert_eq!(
        warm,
        [
            "note: tdc.temperature_c = 65: the TDC was calibrated at 25: an age of a whole period of clk_sys is \
          off by -307.7 ps, others in proportion (expected 25) [chain-drifted]"
        ]
    );
    // The supply of now makes more of it than three degrees; the chain is a hundredth faster.
    let fast = ["tdc.supply_mv=13", "tdc.calibrated_at_mv=0", "tdc.calibrated_at_c=22"];
    let fast = notes(&fast);
    assert!(
        fast[0].starts_with("note: tdc.supply_mv = 13: the TDC was calibrated at 0: "),
        "{fast:?}"
    );
    assert!(fast.len() == 1 && fast[0].contains("off by +81.1 ps"), "{fast:?}");
    // What makes up for each other is no drift.
    let even = ["tdc.delay_per_c=0", "tdc.temperature_c=65", "tdc.calibrated_at_c=25"];
    assert!(notes(&even).is_empty());
    let far = ["target.distance_m=3", "tdc.temperature_c=65", "tdc.calibrated_at_c=25"];
    assert!(notes(&far)[0].ends_with("[echo-past-histogram]"), "no depth to be off");
}

#[test]
fn a_network_that_was_trained_with_the_drift_has_learnt_it() {
    let drift = ["tdc.temperature_c=45", "tdc.calibrated_at_c=25"];
    let mut setup = Setup::load("kc705", &drift).unwrap();
    let codes = |setup: &Setup| -> Vec<_> {
        setup.notes().unwrap().into_iter().map(|note| (note.code, note.key)).collect()
    };
    let key = "tdc.temperature_c".to_owned();
    let both = [NoteCode::OutsideTraining, NoteCode::ChainDrifted].map(|code| (code, key.clone()));
    assert_eq!(codes(&setup), both);
    setup.network.domain = Some(domain::of(&setup.scenario, &[]).unwrap());
    assert_eq!(codes(&setup), []);
    setup.params.estimator = FirmwareEstimator::LikelihoodEstimator;
    assert_eq!(codes(&setup), both[1..]);
}

#[test]
fn the_laser_s_delay_takes_its_part_of_the_histogram() {
    let note = |overrides: &[&str]| {
        let note = Setup::load("kc705", overrides).unwrap().no_depth().cloned();
        note.map(|note| (note.key, note.expected))
    };
    let end = Setup::load("kc705", &[]).unwrap().bins().spans().last().unwrap().until;
    let end_ps = end.fs() as f64 * 1e-3;
    assert!((6_390.0..6_410.0).contains(&end_ps), "{end_ps}");
    let far = "target.distance_m=0.9";
    assert_eq!(note(&[far]), None);
    let (key, expected) = note(&[far, "laser.delay_ps=2000"]).unwrap();
    let below = format!("below {:.3}", (end_ps - 2000.0) * 1.498_962_29e-4);
    assert_eq!((&*key, &*expected), ("target.distance_m", &*below));
    assert_eq!(note(&["target.distance_m=0.65", "laser.delay_ps=2000"]), None);
    let (key, expected) = note(&["target.distance_m=0.1", "laser.delay_ps=7000"]).unwrap();
    assert_eq!((&*key, expected), ("laser.delay_ps", format!("below {end_ps}")));
}
