//! The whole row of the array, and the pulses on `tdc_stop`, against closed forms.

use tofsim::firmware::tof_top::TofTop;
use tofsim::kernel::Time;
use tofsim::optics::dark::DarkRates;
use tofsim::optics::hazard::Cause;
use tofsim::sim::device::{Off, SignalProbe};
use tofsim::sim::fast::histogram::independent_shots;
use tofsim::sim::frames::Frame;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim::sim::shot_recorder::Shot;
use tofsim::sim::{Run, Stepping};

use crate::common::setup;

fn shots(setup: &Setup, frames: u64) -> Vec<Shot> {
    let mut found = Vec::new();
    let mut see = |shot: &Shot| {
        found.push(*shot);
        Ok(())
    };
    let observers = Observers { shots: Some(&mut see), ..Observers::default() };
    Run::new(setup).observe(frames, observers).unwrap();
    found
}

/// Asserts that a count is within four standard deviations of `of` times the probability `chance`.
fn assert_chance(found: usize, of: usize, chance: f64, what: &str) {
    let expected = of as f64 * chance;
    let off = (found as f64 - expected) / (expected * (1.0 - chance)).sqrt();
    assert!(off.abs() < 4.0, "{what}: {found} of {of}, expected {expected:.1}, {off:.2} sigma");
}

/// Light that each of 30 SPADs sees in some of the shots, and shots of 48 ns.
const SCENE: [&str; 6] = [
    "ambient.irradiance_w_m2_nm=0",
    "target.reflectance=0",
    "firmware.laser_freq=3",
    "firmware.shots_per_frame=20000",
    "spad.dark_rate_hz=1e6",
    "estimator.kind=centroid",
];

fn scene(keys: &[&str]) -> Setup {
    setup("kc705", &[&SCENE, keys].concat())
}

/// Chance that one SPAD with such a rate fires between two resets: 40 ns.
fn fires(rate_hz: f64) -> f64 {
    -(-rate_hz * 40e-9).exp_m1()
}

/// The same for a first avalanche from 8 ns on, which is of no other shot.
fn fires_late(rate_hz: f64) -> f64 {
    (-rate_hz * 8e-9).exp() * -(-rate_hz * 32e-9).exp_m1()
}

/// Shots with a first avalanche from 8 ns on.
fn late_hits(setup: &Setup, frames: u64) -> usize {
    let late = 8_000_000..40_000_000;
    let is_late = |shot: &&Shot| shot.arrival_fs.is_some_and(|fs| late.contains(&fs));
    shots(setup, frames).iter().filter(is_late).count()
}

#[test]
fn without_crosstalk_spads_that_are_not_on_the_tdc_change_nothing_there() {
    for on_tdc in ["spad.on_tdc=1", "spad.on_tdc=3"] {
        for spread in ["spad.dark_spread=0", "spad.dark_spread=1"] {
            let setup = scene(&[on_tdc, spread, "spad.row_outputs=30"]);
            let (optics, _) = independent_shots(&setup, "the test").unwrap();
            let none = |ns| (-optics.hazard(false).at(Time::from_ns(ns))).exp();
            let chance = none(8) - none(40);
            assert!((chance - fires_late(setup.budget.dark_rate_hz)).abs() < 1e-9, "{chance}");
            let what = format!("{on_tdc} {spread}");
            assert_chance(late_hits(&setup, 1), 20_000, chance, &what);
        }
    }
}

#[test]
fn crosstalk_brings_the_avalanches_of_neighbours_to_the_tdc() {
    // A neighbour's avalanche sets off the SPAD on the TDC in half of the cases, and that of the one behind it in a
    // quarter; to first order in the light, chances along the row add up on both sides.
    let p = 0.5f64;
    let setup =
        scene(&["spad.row_outputs=31", "spad.crosstalk_probability=0.5", "spad.dark_rate_hz=1e4"]);
    let one = fires_late(1e4);
    let along: f64 = (1..=15).map(|distance| 2.0 * p.powi(distance)).sum();
    assert_chance(late_hits(&setup, 2), 40_000, one * (1.0 + along), "crosstalk");
    let refused = independent_shots(&setup, "the test").unwrap_err().to_string();
    assert!(refused.contains("spad.crosstalk_probability = 0.5"), "{refused}");
    let alone = scene(&["spad.crosstalk_probability=0.5", "spad.dark_rate_hz=1e4"]);
    assert!(independent_shots(&alone, "the test").is_ok());
}

#[test]
fn every_spad_of_the_row_is_followed_to_the_end_of_its_shot() {
    let setup = scene(&["spad.row_outputs=30", "spad.on_tdc=30", "spad.dark_rate_hz=2e7"]);
    let mut high = [0usize; 30];
    let mut count = 0;
    let (mut device, p) = (setup.device(), &setup.params);
    device.power_up(&mut Off, &mut Off);
    let mut last = Outputs::default();
    while count < 4000 {
        device.step(p, &mut last, &mut Off);
        if let Some(outputs) = last.at_reset.take() {
            count += 1;
            high.iter_mut().enumerate().for_each(|(k, high)| *high += (outputs >> k & 1) as usize);
        }
    }
    for (output, high) in high.into_iter().enumerate() {
        assert_chance(high, count, fires(2e7), &format!("output {output}"));
    }
}

/// Outputs of the row just before a reset.
#[derive(Default)]
struct Outputs {
    now: u64,
    before: u64,
    was_reset: bool,
    at_reset: Option<u64>,
}

impl SignalProbe for Outputs {
    const ON: bool = true;

    fn outputs(&mut self, outputs: u64) {
        self.before = std::mem::replace(&mut self.now, outputs);
    }

    fn sample(&mut self, _: Time, top: &TofTop) {
        let reset = top.spad_control.spad_rst && top.frame_ctrl.acquire;
        if reset && !self.was_reset && top.frame_ctrl.shots() > 1 {
            assert_eq!(self.now, 0, "a reset ends every output");
            self.at_reset = Some(self.before);
        }
        self.was_reset = reset;
    }
}

#[test]
fn a_hot_spad_beside_the_one_on_the_tdc_makes_none_of_its_hits_dark() {
    let folder = crate::common::empty();
    let path = folder.path().join("dark.csv");
    std::fs::write(&path, "row,output,rate_hz\n0,15,0\n0,14,1e8\n1,15,1e8\n").unwrap();
    let file = format!("spad.dark_file={}", path.display());
    let lit =
        ["spad.row_outputs=30", "ambient.irradiance_w_m2_nm=0.4", "target.reflectance=0.6", &file];
    let found = shots(&scene(&lit), 1);
    let causes: Vec<_> = found.iter().filter_map(|shot| shot.cause).collect();
    assert!(causes.len() > 5_000, "{}", causes.len());
    assert!(causes.iter().all(|cause| *cause != Cause::Dark));
    let warm = ["spad.on_tdc=2", "spad.temperature_c=28", &file];
    let setup = scene(&warm);
    // 15 and 16, which is not named.
    assert_eq!(setup.budget.dark_rate_hz, 2e6);
    assert_eq!((setup.dark.on_tdc_hz(), setup.dark.one_hz()), (2e6, 0.0));
    assert_chance(late_hits(&setup, 1), 20_000, fires_late(2e6), "measured rates");
    let causes = shots(&setup, 1);
    assert!(causes.iter().all(|shot| shot.cause.is_none_or(|cause| cause == Cause::Dark)));
    assert_ne!(DarkRates::new(&setup.scenario.spad, None), setup.dark);
}

fn frames(setup: &Setup, stepping: Stepping, threads: bool) -> Vec<Frame> {
    let mut frames = Vec::new();
    let mut take = |frame: &Frame| {
        frames.push(frame.clone());
        Ok(())
    };
    let observers = Observers { frames: Some(&mut take), ..Observers::default() };
    let run = Run::new(setup).stepping(stepping);
    if threads { run.many(3, observers) } else { run.observe(3, observers) }.unwrap();
    frames
}

#[test]
fn fast_ways_give_the_same_frames_with_a_whole_row_and_with_a_shaper() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    for keys in [
        &["spad.row_outputs=30", "spad.crosstalk_probability=0.2"][..],
        &["spad.row_outputs=30", "spad.on_tdc=4", "spad.afterpulse_probability=0.2"],
        &["spad.row_outputs=30", "firmware.mode=1", "spad.dark_spread=1"],
        &["spad.pulse_ns=3", "spad.pulse_gap_ns=70"],
        &[
            "spad.pulse_gap_ns=100",
            "firmware.mode=1",
            "spad.on_tdc=4",
            "ambient.irradiance_w_m2_nm=0.005",
        ],
    ] {
        let lit = [
            "ambient.irradiance_w_m2_nm=0.4",
            "target.reflectance=0.6",
            "firmware.shots_per_frame=300",
        ];
        let setup = scene(&[&lit, keys].concat());
        let plain = frames(&setup, Stepping::EveryCycle, false);
        assert!(plain[0].tdc_hits > 9, "{keys:?}: {}", plain[0].tdc_hits);
        for stepping in [Stepping::SkipIdle, Stepping::LeapShots] {
            assert_eq!(frames(&setup, stepping, false), plain, "{keys:?} {stepping:?}");
            let apart = pool.install(|| frames(&setup, stepping, true));
            assert_eq!(apart, plain, "{keys:?} {stepping:?} on two threads");
        }
    }
}

/// Of the avalanches that come in the middle of a shot, how many there are, and of how many the TDC saw a hit.
fn seen(setup: &Setup) -> (usize, usize) {
    let shots = shots(setup, 1);
    // From 8 ns on, for two periods of clk_sys: none is near a border of the window.
    let comes =
        |shot: &&Shot| shot.arrival_fs.is_some_and(|fs| (8_000_000..24_000_000).contains(&fs));
    let all: Vec<_> = shots.iter().filter(comes).collect();
    (all.len(), all.iter().filter(|shot| shot.n.is_some()).count())
}

#[test]
fn pulses_narrower_than_a_period_fall_between_two_samples_as_often_as_they_should() {
    for (width_ns, chance) in [(0.5, 0.0625), (2.0, 0.25), (6.0, 0.75), (8.0, 1.0), (20.0, 1.0)] {
        let setup = scene(&[&format!("spad.pulse_ns={width_ns}"), "tdc.coarse_bits=5"]);
        let (all, seen) = seen(&setup);
        assert!(all > 200, "{all}");
        match chance < 1.0 {
            true => assert_chance(seen, all, chance, &format!("{width_ns} ns")),
            false => assert_eq!(seen, all, "{width_ns} ns"),
        }
    }
}

/// When `tdc_stop` changes in a run of so many cycles [fs].
fn changes(setup: &Setup, cycles: u64) -> Vec<(u64, bool)> {
    struct Stop(Vec<(u64, bool)>);
    impl SignalProbe for Stop {
        const ON: bool = true;
        fn sample(&mut self, now: Time, top: &TofTop) {
            if self.0.last().map_or(top.pins.tdc_stop, |(_, level)| *level != top.pins.tdc_stop) {
                self.0.push((now.fs(), top.pins.tdc_stop));
            }
        }
    }
    let (mut device, mut stop) = (setup.device(), Stop(Vec::new()));
    device.power_up(&mut Off, &mut Off);
    (0..cycles).for_each(|_| device.step(&setup.params, &mut stop, &mut Off));
    stop.0
}

#[test]
fn a_pulse_has_its_width_whatever_the_reset_does_and_none_comes_in_the_gap() {
    for (mode, width_ns, gap_ns) in [(0, 13, 70), (1, 13, 70), (0, 60, 0), (1, 3, 0)] {
        let keys = [
            format!("firmware.mode={mode}"),
            format!("spad.pulse_ns={width_ns}"),
            format!("spad.pulse_gap_ns={gap_ns}"),
            "spad.dark_rate_hz=3e7".to_owned(),
        ];
        let found = changes(&scene(&keys.each_ref().map(String::as_str)), 20_000);
        assert!(found.len() > 1000, "{}", found.len());
        for pair in found.windows(2) {
            let span = pair[1].0 - pair[0].0;
            match pair[0].1 {
                true => assert_eq!(span % (width_ns * 1_000_000), 0, "{mode} {width_ns}: {span}"),
                false => assert!(span >= gap_ns * 1_000_000, "{mode} {gap_ns}: {span}"),
            }
        }
    }
}

#[test]
fn in_mode_1_the_rate_of_pulses_is_that_of_a_dead_time_of_pulse_and_gap() {
    // The SPAD's own dead time of 5 ns hides few of the rises that the shaper would take.
    let keys = [
        "firmware.mode=1",
        "spad.dead_time_ns=5",
        "spad.dark_rate_hz=2e6",
        "spad.pulse_ns=40",
        "spad.pulse_gap_ns=110",
    ];
    let cycles = 400_000;
    let rises = changes(&scene(&keys), cycles).iter().filter(|(_, level)| *level).count() as f64;
    let seconds = cycles as f64 * 8e-9;
    let through_hz = 2e6 / (1.0 + 2e6 * 5e-9);
    let expected = seconds * through_hz / (1.0 + through_hz * 150e-9);
    // A renewal process with that dead time scatters less than a Poisson process.
    assert!((rises - expected).abs() < 4.0 * expected.sqrt(), "{rises} for {expected}");
}
