use super::*;
use tofsim::scenario;

/// Keys of the notes of an estimator under overrides, those of the scene too.
fn keys(kind: EstimatorKind, overrides: &[&str]) -> Vec<String> {
    let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
    let setup = Setup::new(scenario::load("kc705", &overrides).unwrap()).unwrap();
    kind.notes_of_scene(&setup).into_iter().map(|note| note.key).collect()
}

#[test]
fn an_estimator_within_its_model_says_nothing() {
    for kind in [
        EstimatorKind::Network,
        EstimatorKind::Likelihood,
        EstimatorKind::LikelihoodEstimator,
        EstimatorKind::Matched,
    ] {
        assert!(keys(kind, &[]).is_empty(), "{kind:?}");
        assert!(keys(kind, &["laser.pulse_sigma_ps=200"]).is_empty(), "{kind:?}");
    }
    let known = ["firmware.mode=1", "pll.jitter_rms_ps=50"];
    assert!(keys(EstimatorKind::Likelihood, &known).is_empty());
}

#[test]
fn what_an_estimator_does_not_know_is_named() {
    use EstimatorKind::{Centroid, Likelihood, LikelihoodEstimator, Matched, Peak, Subtraction};
    for (kind, set, key) in [
        (Matched, "firmware.mode=1", "firmware.mode"),
        (Centroid, "firmware.mode=1", "firmware.mode"),
        (Peak, "firmware.mode=1", "firmware.mode"),
        (Matched, "pll.jitter_rms_ps=50", "pll.jitter_rms_ps"),
        (Matched, "pll.jitter_rms_ps=7.7", "pll.jitter_rms_ps"),
        (LikelihoodEstimator, "pll.jitter_rms_ps=7.7", "pll.jitter_rms_ps"),
        (Centroid, "pll.jitter_rms_ps=50", "pll.jitter_rms_ps"),
        (Peak, "laser.pulse_sigma_ps=200", "laser.pulse_sigma_ps"),
        (Subtraction, "laser.pulse_sigma_ps=100", "laser.pulse_sigma_ps"),
        (Subtraction, "target.distance_m=0.7", "target.distance_m"),
        (Peak, "target.distance_m=0.05", "target.distance_m"),
        (Matched, "target.distance_m=0.04", "target.distance_m"),
        (Likelihood, "target.distance_m=0.04", "target.distance_m"),
        (Centroid, "laser.pulse_sigma_ps=200", "estimator.centroid_half_width"),
        (Centroid, "tdc.bin_ps=40", "estimator.centroid_slope_m"),
        (Centroid, "tdc.first_bin_ps=1000", "estimator.centroid_offset_m"),
        (Centroid, "laser.delay_ps=600", "estimator.centroid_offset_m"),
        (Peak, "laser.delay_ps=10", "laser.delay_ps"),
        (Subtraction, "laser.delay_ps=10", "laser.delay_ps"),
        (Peak, "tdc.bin_ps=24", "tdc.bin_ps"),
        (Subtraction, "tdc.first_bin_ps=1000", "tdc.first_bin_ps"),
        (Likelihood, "spad.afterpulse_probability=0.001", "spad.afterpulse_probability"),
        (LikelihoodEstimator, "spad.afterpulse_probability=0.001", "spad.afterpulse_probability"),
        (Matched, "spad.afterpulse_probability=0.001", "spad.afterpulse_probability"),
        (Peak, "spad.afterpulse_probability=0.05", "spad.afterpulse_probability"),
        (Centroid, "target.distance_m=0.3", "--estimator"),
        (Peak, "target.distance_m=0.1", "--estimator"),
    ] {
        let found = keys(kind, &[set]);
        assert!(found.iter().any(|found| found == key), "{kind:?} {set}: {found:?}");
    }
    let found = keys(Likelihood, &["firmware.mode=1", "spad.dead_time_ns=6"]);
    assert_eq!(found, ["spad.dead_time_ns"]);
    let found = keys(Likelihood, &["firmware.mode=1", "spad.on_tdc=2"]);
    assert_eq!(found, ["spad.on_tdc"]);
    let found = keys(Likelihood, &["firmware.mode=1", "spad.dead_time_kind=paralysable"]);
    assert_eq!(found, ["spad.dead_time_kind"]);
    let found = keys(Likelihood, &["firmware.mode=1", "target.distance_m=0.65"]);
    assert_eq!(found, ["target.distance_m"]);
    let found = keys(Likelihood, &["pll.jitter_rms_ps=50", "target.distance_m=0.86"]);
    assert_eq!(found, ["target.distance_m"]);
    assert_eq!(keys(Likelihood, &["spad.dead_time_ns=6"]), [""; 0]);
}

#[test]
fn with_what_the_notes_expect_other_bins_are_known() {
    let bins = ["tdc.bin_ps=40", "tdc.first_bin_ps=1000"];
    let own = ["estimator.centroid_slope_m=0.005995849", "estimator.centroid_offset_m=0.1498962"];
    let of_bins = |set: &[&str]| {
        let scale = ["estimator.centroid_slope_m", "estimator.centroid_offset_m"];
        let found = keys(EstimatorKind::Centroid, set);
        found.into_iter().filter(|key| scale.contains(&key.as_str())).count()
    };
    assert_eq!((of_bins(&bins), of_bins(&[bins, own].concat())), (1, 0));
    for kind in [EstimatorKind::Likelihood, EstimatorKind::Matched] {
        assert!(keys(kind, &bins).is_empty(), "{kind:?}");
    }
}

#[test]
fn the_laser_s_delay_is_known_to_those_that_know_the_pulse_and_may_be_told_to_the_centroid() {
    let late = ["laser.delay_ps=600", "target.distance_m=0.3"];
    for kind in
        [EstimatorKind::Likelihood, EstimatorKind::LikelihoodEstimator, EstimatorKind::Matched]
    {
        assert!(keys(kind, &late).is_empty(), "{kind:?}");
    }
    let faint = ["spad.pdp=0.00001", "spad.dark_rate_hz=0", "ambient.irradiance_w_m2_nm=0"];
    let told = ["estimator.centroid_offset_m=-0.08993774"];
    let found = keys(EstimatorKind::Centroid, &[&late[..], &faint].concat());
    assert!(found.contains(&"estimator.centroid_offset_m".to_owned()), "{found:?}");
    assert_eq!(keys(EstimatorKind::Centroid, &[&late[..], &faint, &told].concat()), [""; 0]);
}

#[test]
fn a_centroid_without_pile_up_says_nothing() {
    let faint = ["spad.pdp=0.00001", "spad.dark_rate_hz=0", "ambient.irradiance_w_m2_nm=0"];
    assert_eq!(keys(EstimatorKind::Centroid, &faint), [""; 0]);
}

#[test]
fn the_centroid_in_the_firmware_says_the_same_by_its_key() {
    let of = |set: &[&str]| {
        let set: Vec<_> = set.iter().map(|&text| text.to_owned()).collect();
        notes_of_firmware(&Setup::new(scenario::load("kc705", &set).unwrap()).unwrap())
    };
    assert!(of(&[]).is_empty());
    let notes = of(&["estimator.kind=centroid", "firmware.mode=1"]);
    let keys: Vec<_> = notes.iter().map(|note| &*note.key).collect();
    assert_eq!(keys, ["firmware.mode"]);
    assert_eq!(of(&["estimator.kind=centroid"])[0].key, "estimator.kind");
}

#[test]
fn a_note_says_how_far_off_the_estimate_is() {
    let setup = Setup::new(scenario::load("kc705", &[]).unwrap()).unwrap();
    let notes = EstimatorKind::Centroid.notes_of_scene(&setup);
    let text = notes[0].text.as_str();
    assert!(text.starts_with("centroid: in the expected histogram"), "{text}");
    assert!(
        text.contains("it is off by -15.6 mm")
            && text.ends_with("pile-up shifts the centroid short"),
        "{text}"
    );
}
