//! Every estimator by its name, and those of the firmware against their blocks.

use tofsim::kernel::pulse::Pulse;
use tofsim::sim::{Run, Stepping};

use super::*;
use crate::estimation::Panel;

#[test]
fn every_estimator_answers_to_its_name() {
    let setup = &Setup::load("kc705", &["tdc.profile=ideal"]).unwrap();
    let bins = &setup.bins();
    let network = &Network::builtin("ideal").unwrap().unwrap();
    let gaussian = |sigma_ps| Pulse::Gaussian { sigma_ps };
    let pulse = gaussian(137.0);
    let acquisition = Acquisition::new(bins, 30_000, &pulse);
    let needs = EstimatorInputs { acquisition, network, setup };
    for &(name, kind, _) in EstimatorKind::ALL {
        assert_eq!(kind.estimator(&needs).unwrap().name(), name);
        assert_eq!((kind.name(), EstimatorKind::find(name)), (name, Some(kind)));
    }
    for (shots, sigma_ps, field) in
        [(0, 137.0, "shots = 0"), (1 << 24, 137.0, "shots"), (1, f64::NAN, "pulse = NaN")]
    {
        let pulse = gaussian(sigma_ps);
        let acquisition = Acquisition::new(bins, shots, &pulse);
        let needs = EstimatorInputs { acquisition, network, setup };
        let fault = EstimatorKind::Peak.estimator(&needs).err().unwrap().to_string();
        assert!(fault.contains(field), "{fault}");
    }
}

#[test]
fn every_estimator_of_the_firmware_is_registered_and_gives_the_words_of_its_block() {
    for firmware in FirmwareEstimator::ALL {
        let kind = format!("estimator.kind={}", firmware.name());
        let setup = Setup::load("kc705", &[&kind]).unwrap();
        let in_socket = EstimatorKind::in_socket(&setup.scenario);
        assert_eq!((in_socket.name(), in_socket.is_in_firmware()), (firmware.estimator(), true));
        let frame = Run::new(&setup).stepping(Stepping::LeapShots).frames(1).unwrap().remove(0);
        let panel = Panel::new(&[in_socket], &setup).unwrap();
        let found = panel.read(&frame.histogram).remove(0);
        let own = frame.estimate();
        assert_eq!((found.depth_m, found.sigma_m), (own.depth_m, own.sigma_m), "{firmware:?}");
        assert_eq!((found.valid, found.status), (own.valid, own.status), "{firmware:?}");
    }
}
