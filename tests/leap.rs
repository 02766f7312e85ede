//! Shots leapt over come to what stepping them gives, and single outcomes to the firmware's.

use tofsim::firmware::vcsel_driver;
use tofsim::kernel::Time;
use tofsim::scenario;
use tofsim::sim::device::Off;
use tofsim::sim::fast::{NO_HIT, ShotOutcomes, Tables, acquire, leap_shots};
use tofsim::sim::frames::Frames;
use tofsim::sim::setup::Setup;

use crate::common;

/// Cycles of Drain, after which the histogram has all codes of a frame.
const DRAIN: u64 = 16;

#[test]
fn a_leap_lands_where_the_histogram_and_the_counts_are_what_stepping_gives() {
    let folder = common::empty();
    for seed in 0..8 {
        let converter = common::CONVERTERS[[0, 3, 0, 4, 0, 5, 1, 2][seed]];
        let [profile, calibration] = common::converter(converter, folder.path());
        let keys = [
            profile,
            calibration,
            format!("firmware.laser_freq={}", seed % 4),
            "firmware.shots_per_frame=400".to_owned(),
            format!("target.distance_m={}", [0.02, 0.3, 0.9][seed % 3]),
            common::CLOCKS[seed % 4].to_owned(),
            format!("seed={seed}"),
        ];
        let setup = Setup::new(scenario::load("kc705", &keys).unwrap()).unwrap();
        let p = &setup.params;
        let mut stepped = setup.device();
        stepped.power_up(&mut Off, &mut Off);
        while !stepped.top.frame_ctrl.acquire {
            stepped.step(p, &mut Off, &mut Off);
        }
        let (mut leapt, mut tables, mut leaps) = (stepped.clone(), Tables::default(), 0);
        let mut frames = [Frames::default(), Frames::default()];
        acquire(&mut leapt, p, &mut frames[0], u64::MAX, |device, frames, hits| {
            let before = device.cycle();
            leap_shots(device, p, &mut tables, frames, hits);
            leaps += u64::from(device.cycle() > before);
        });
        while stepped.cycle() < leapt.cycle() {
            stepped.step(p, &mut Off, &mut Off);
            frames[1].count_shot(&stepped.top);
            frames[1].count_hit(&stepped.top);
        }
        assert_eq!(leaps, 1, "from the first shot to the last");
        assert_eq!(leapt.top.frame_ctrl, stepped.top.frame_ctrl);
        assert_eq!(leapt.top.vcsel_driver, stepped.top.vcsel_driver);
        assert_eq!(leapt.top.tdc.coarse_counter, stepped.top.tdc.coarse_counter);
        assert_eq!(frames[0].shots(), 400);
        assert_eq!(format!("{:?}", frames[0]), format!("{:?}", frames[1]));
        // A leap counts a code at once, and the decoder takes a while.
        for device in [&mut leapt, &mut stepped] {
            (0..DRAIN).for_each(|_| device.step(p, &mut Off, &mut Off));
        }
        assert_eq!(leapt.top.histogram_builder, stepped.top.histogram_builder, "seed {seed}");
    }
}

/// A photon for each shot, at every step of the staircase and a femtosecond either side of it; the
/// last shot, after which no reset of the SPAD follows, has none.
#[test]
fn the_staircase_of_outcomes_is_the_firmware_s_to_the_femtosecond() {
    let folder = tempfile::tempdir().unwrap();
    for ([chain, calibration], clock) in [
        (["uniform", "true"], common::CLOCKS[0]),
        (["table6_3", "true"], common::CLOCKS[0]),
        (["ideal", "true"], common::CLOCKS[0]),
        (["uniform", "true"], common::CLOCKS[1]),
        (["ideal", "true"], common::CLOCKS[2]),
        (["kintex7", "true"], common::CLOCKS[0]),
        (["kintex7", "uniform"], common::CLOCKS[0]),
        (["kintex7", "jumbled"], common::CLOCKS[0]),
    ] {
        let keys = common::converter([chain, calibration], folder.path());
        let [profile, calibration] = keys.each_ref().map(String::as_str);
        for (rate, period) in vcsel_driver::PERIODS.into_iter().enumerate() {
            let plain = common::setup("kc705", &[profile, calibration, clock]);
            let outcomes = ShotOutcomes::new(&plain.params.tdc, period).unwrap();
            let steps = outcomes
                .steps()
                .iter()
                .flat_map(|(begin, _)| [begin.fs().saturating_sub(1), begin.fs(), begin.fs() + 1]);
            let arrivals: Vec<_> = steps.collect();
            let mut text = "shot,arrival_ps\n".to_owned();
            for (shot, fs) in arrivals.iter().enumerate() {
                text += &format!("{shot},{}.{:03}\n", fs / 1000, fs % 1000);
            }
            let path = folder.path().join("photons.csv");
            std::fs::write(&path, text).unwrap();
            let photons = format!("stimulus.photons={:?}", path.display().to_string());
            let (freq, shots) = (
                format!("firmware.laser_freq={rate}"),
                format!("firmware.shots_per_frame={}", arrivals.len() + 1),
            );
            let keys = [profile, calibration, clock, &photons, &freq, &shots];
            let setup = common::setup("kc705", &keys);
            let frame = &common::frames(&setup, 1)[0];
            let (mut histogram, mut tdc_hits) = ([0u32; 256], 0);
            for fs in &arrivals {
                let outcome = outcomes.of(Time::from_fs(*fs));
                if let Some(count) = histogram.get_mut(outcome as usize) {
                    *count += 1;
                }
                tdc_hits += u64::from(outcome != NO_HIT);
            }
            assert_eq!(frame.histogram, histogram, "{chain} {calibration} {clock} {rate}");
            assert_eq!(frame.tdc_hits, tdc_hits, "{chain} {calibration} {clock} {rate}");
        }
    }
}
