//! Maximum likelihood on frames of the simulator, with jitter and in MODE 1.

use tofsim::sim::setup::Setup;
use tofsim::sim::{Run, Stepping};
use tofsim::{Frame, Observers, scenario};
use tofsim_learn::estimation::{EstimatorKind, Panel};

/// Mean error over ten frames [mm].
fn mean_error_mm(overrides: &[&str]) -> f64 {
    let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
    let setup = Setup::new(scenario::load("kc705", &overrides).unwrap()).unwrap();
    let panel = Panel::new(&[EstimatorKind::Likelihood], &setup).unwrap();
    let truth_m = setup.true_depth_m().unwrap();
    let mut errors_m = Vec::new();
    let mut take = |frame: &Frame| {
        let [reading] = &panel.read(&frame.histogram)[..] else { panic!("one estimator") };
        errors_m.push(reading.depth_m.unwrap() - truth_m);
        Ok(())
    };
    let observers = Observers { frames: Some(&mut take), ..Observers::default() };
    Run::new(&setup).stepping(Stepping::LeapShots).many(10, observers).unwrap();
    1e3 * errors_m.iter().sum::<f64>() / errors_m.len() as f64
}

#[test]
fn jitter_does_not_move_the_likelihood() {
    // Without the convolution it is 16.6 mm off here.
    let error_mm = mean_error_mm(&["pll.jitter_rms_ps=50", "target.distance_m=0.1"]);
    assert!(error_mm.abs() < 1.0, "{error_mm} mm");
}

#[test]
fn a_free_running_diode_does_not_move_the_likelihood() {
    // Without the arming it is 44 and 19 mm off here.
    for (distance, laser_freq) in [("0.1", "3"), ("0.3", "2")] {
        let distance = format!("target.distance_m={distance}");
        let rate = format!("firmware.laser_freq={laser_freq}");
        let error_mm = mean_error_mm(&["firmware.mode=1", &distance, &rate]);
        assert!(error_mm.abs() < 1.5, "{distance} {rate}: {error_mm} mm");
    }
}
