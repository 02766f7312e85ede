use super::*;
use crate::sim::{Run, Stepping};

#[test]
fn a_dark_frame_of_a_pair_has_no_opinion() {
    let setup = Setup::load("kc705", &["firmware.dark_frames=true"]).unwrap();
    let second = SecondOpinion::new(&setup).unwrap();
    let frames = Run::new(&setup).stepping(Stepping::LeapShots).frames(2).unwrap();
    assert!(second.of(&frames[0]).is_none());
    assert!(second.of(&frames[1]).unwrap().status.is_empty());
}

#[test]
fn where_its_model_does_not_hold_it_says_why_there_is_none() {
    for (set, key) in [
        ("firmware.mode=1", "firmware.mode"),
        ("laser.timing_jitter_ps=5", "laser.timing_jitter_ps"),
        ("laser.energy_jitter=0.1", "laser.energy_jitter"),
        ("spad.afterpulse_probability=0.01", "spad.afterpulse_probability"),
        ("tdc.first_bin_ps=1000", "tdc.first_bin_ps"),
        ("pll.jitter_rms_ps=10", "pll.jitter_rms_ps"),
        ("laser.pulse_sigma_ps=5", "laser.pulse_sigma_ps"),
    ] {
        let few = "firmware.shots_per_frame=200";
        let why = SecondOpinion::new(&Setup::load("kc705", &[set, few]).unwrap()).unwrap_err();
        assert_eq!((why.key.as_str(), why.code), (key, NoteCode::SecondOpinion), "{why}");
        assert!(why.to_string().contains("there is no second opinion"), "{why}");
    }
    let listed = Setup::load("tdc_validation", &[]).unwrap();
    assert_eq!(SecondOpinion::new(&listed).unwrap_err(), *listed.no_depth().unwrap());
}

#[test]
fn the_network_is_as_exact_as_its_file_says_and_half_a_bin_where_it_says_nothing() {
    let accuracy = Accuracy {
        distances_m: vec![0.1, 0.2],
        two_sd_mm: vec![6.0, 8.0],
        mean_mm: Some(vec![4.0, 4.0]),
    };
    let socket = Socket { name: "network", accuracy: Some(accuracy), bin_m: 0.004 };
    let expected = [(0.05, 3f64), (0.1, 3.0), (0.15, 3.5), (0.2, 4.0), (0.9, 4.0)];
    for (depth_m, sd_mm) in expected {
        assert!((socket.deviation_m(depth_m) - 1e-3 * sd_mm.hypot(4.0)).abs() < 1e-12, "{depth_m}");
    }
    assert_eq!(Socket { accuracy: None, ..socket }.deviation_m(0.1), 0.002);
}
