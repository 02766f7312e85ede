//! Tests that skipping in modules, and every fast path of the device, equal the plain step, from all states that
//! random runs visit.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use tofsim::firmware::tof_top::{Params, TofTop, Wires};
use tofsim::firmware::{tdc, vcsel_driver};
use tofsim::hierarchy::{self, Entry, Kind};
use tofsim::kernel::signals::Sink;
use tofsim::kernel::{Clocked, Thermometer, Time};
use tofsim::scenario::QuenchMode::{EachShot, FreeRunning};
use tofsim::scenario::{self, Control};
use tofsim::sim::Device;
use tofsim::sim::device::Off;
use tofsim::sim::fast::{acquire, leap_frame_end, skip_idle};
use tofsim::sim::frames::Frames;
use tofsim::sim::setup::Setup;

use crate::common;

/// Edges that are tried at most from one state.
const EDGES: u64 = 40;

/// Counts the signals that differ.
#[derive(Default)]
struct Differences(Vec<usize>);

impl Sink for Differences {
    fn word(&mut self, id: usize, _: u64) {
        self.0.push(id);
    }
    fn taps(&mut self, id: usize, _: &Thermometer, _: usize) {
        self.0.push(id);
    }
}

/// Compares all signals, but for those of modules that only watch, just before the next edge: who steps
/// has seen what happened by mid-cycle.
fn assert_same(found: &Device, expected: &Device, what: &str) {
    let [found, expected] = [found, expected].map(|device| {
        let mut device = device.clone();
        let before_edge = device.next_edge().since(Time::from_fs(1));
        device.settle(before_edge, &mut Off, &mut Off);
        device
    });
    let mut differences = Differences::default();
    hierarchy::changes(&found.top, Some(&expected.top), &mut differences);
    if !differences.0.is_empty() {
        let mut entries = hierarchy::every_entry();
        entries.retain(|entry| differences.0.contains(&entry.id) && !watches(&entry.path()));
        let names: Vec<_> = entries.iter().map(Entry::path).collect();
        assert!(names.is_empty(), "{what} at cycle {}: {names:?}", expected.cycle());
    }
    assert_eq!(found.cycle(), expected.cycle(), "{what}");
    // What has no signals of its own.
    assert_eq!(found.top.histogram_builder, expected.top.histogram_builder, "{what}");
    assert_eq!(found.top.centroid_estimator, expected.top.centroid_estimator, "{what}");
    assert!(found.top.likelihood_estimator == expected.top.likelihood_estimator, "{what}");
    assert_eq!(found.top.slot, expected.top.slot, "{what}");
}

/// Whether a path is that of a module that only watches, or of a signal of one.
fn watches(path: &str) -> bool {
    let inside = |module: &&str| path.split('.').any(|part| part == *module);
    Wires::WATCHERS.iter().any(inside)
}

#[test]
fn nothing_reads_a_module_that_only_watches() {
    let (watching, others): (Vec<_>, Vec<_>) =
        hierarchy::every_entry().into_iter().partition(|entry| watches(&entry.path()));
    let own = |id| watching.iter().any(|entry| entry.kind != Kind::Input && entry.id == id);
    let read: Vec<_> = others.iter().filter(|entry| own(entry.id)).map(Entry::path).collect();
    assert!(read.is_empty(), "{read:?}");
}

/// The same, and from there on as well, lest something hidden differ.
fn assert_same_on_and_on(found: &Device, expected: &Device, p: &Params, what: &str) {
    let (mut found, mut expected) = (found.clone(), expected.clone());
    for steps in [0, 1, 2, 12] {
        for device in [&mut found, &mut expected] {
            (0..steps).for_each(|_| device.step(p, &mut Off, &mut Off));
        }
        assert_same(&found, &expected, what);
    }
}

/// Checks, edge by edge, that `skip` does what `next` would have done.
fn assert_skip_is_exact<M: Clocked>(module: &M, i: &M::In, p: &M::Params) -> u64 {
    let (mut stepped, quiet) = (*module, module.quiet(i, p));
    for edges in 1..=quiet.min(EDGES) {
        stepped = stepped.next(i, p);
        let mut skipped = *module;
        skipped.skip(i, p, edges);
        assert_eq!(skipped, stepped, "after {edges} of {quiet} quiet edges");
    }
    quiet
}

/// The driver has edges of its own between those of `clk_sys`.
fn assert_laser_skips_exactly(
    driver: &vcsel_driver::VcselDriver,
    i: &vcsel_driver::In,
    p: &vcsel_driver::Params,
) {
    let (mut stepped, quiet) = (*driver, driver.quiet(i, p));
    for edges in 1..=quiet.min(EDGES) {
        stepped.rise(i, p);
        stepped.fall_laser();
        stepped.rise_laser(i, p);
        stepped.fall_laser();
        let mut skipped = *driver;
        skipped.skip(i, p, edges);
        assert_eq!(skipped, stepped, "after {edges} of {quiet} quiet edges");
    }
}

/// Every module in the state it is in; returns how many are quiet.
fn check_modules(top: &TofTop, setup: &Setup) -> usize {
    let (p, i) = (&setup.params, Wires::tdc(top));
    let tdc_params = &p.tdc;
    assert_laser_skips_exactly(&top.vcsel_driver, &Wires::vcsel_driver(top), &p.vcsel_driver);
    let quiet = [
        assert_skip_is_exact(&top.reset_sync_sys, &Wires::reset_sync_sys(top), &()),
        assert_skip_is_exact(&top.reset_sync_laser, &Wires::reset_sync_laser(top), &()),
        assert_skip_is_exact(&top.control_sync, &Wires::control_sync(top), &p.control_sync()),
        assert_skip_is_exact(&top.frame_ctrl, &Wires::frame_ctrl(top), &p.frame_ctrl),
        assert_skip_is_exact(
            &top.vcsel_driver.registers,
            &Wires::vcsel_driver(top),
            &p.vcsel_driver,
        ),
        assert_skip_is_exact(&top.spad_control, &Wires::spad_control(top), &()),
        assert_skip_is_exact(
            &top.tdc.coarse_counter,
            &tdc::Wires::coarse_counter(&top.tdc, &i),
            &tdc_params.coarse_counter,
        ),
        assert_skip_is_exact(
            &top.tdc.tdc_latch,
            &tdc::Wires::tdc_latch(&top.tdc, &i),
            &tdc_params.delays.tap_0_position(),
        ),
        assert_skip_is_exact(
            &top.tdc.tdc_decoder,
            &tdc::Wires::tdc_decoder(&top.tdc, &i),
            &tdc_params.decoder,
        ),
        assert_skip_is_exact(&top.code_preload, &Wires::code_preload(top), &[Default::default()]),
    ];
    quiet.iter().filter(|&&quiet| quiet > 0).count()
}

/// Changes of the control signals, now and then at an edge.
fn control(random: &mut ChaCha8Rng, cycles: u64) -> Vec<Control> {
    let mut changes = Vec::new();
    let mut cycle = 300;
    while cycle < cycles {
        let offset_ns = [0.0, 3.7][random.random_range(0..2)];
        let at_us = 1.008 + 0.008 * cycle as f64 + offset_ns / 1e3;
        let mut pair =
            [0.0, 0.5].map(|later| Control { at_us: at_us + later, ..Control::default() });
        match random.random_range(0..7) {
            0 => [pair[0].rst, pair[1].rst] = [Some(true), Some(false)],
            1 => [pair[0].dsp_rst, pair[1].dsp_rst] = [Some(true), Some(false)],
            2 => [pair[0].dsp_en, pair[1].dsp_en] = [Some(false), Some(true)],
            3 => [pair[0].mode, pair[1].mode] = [Some(FreeRunning), Some(EachShot)],
            4 => pair[1].laser_en = Some(random.random_bool(0.8)),
            _ => pair[0].laser_freq = Some(random.random_range(0..4)),
        }
        changes.extend(pair);
        cycle += random.random_range(80..900);
    }
    changes
}

fn random_setup(seed: u64, cycles: u64) -> Setup {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let folder = common::empty();
    let converter = common::CONVERTERS[random.random_range(0..common::CONVERTERS.len())];
    let [profile, calibration] = common::converter(converter, folder.path());
    let mode = u64::from(seed % 5 == 4);
    // The likelihood estimator is for mode 0.
    let kind = ["network", "centroid", "likelihood"][random.random_range(0..3 - mode as usize)];
    let stimulus = match seed % 8 {
        5 => "histogram_validation",
        6 => "estimator_validation",
        7 => "tdc_validation",
        _ => "kc705",
    };
    let on_tdc = if stimulus == "tdc_validation" { 1 } else { 1 + 6 * (seed / 2 % 3) };
    let keys = [
        format!("spad.on_tdc={on_tdc}"),
        format!("spad.afterpulse_probability={}", [0.0, 0.5, 0.1][seed as usize % 3]),
        format!("laser.delay_ps={}", [0, 700, 0][seed as usize % 3]),
        format!("spad.dead_time_kind={}", ["fixed", "paralysable"][seed as usize / 3 % 2]),
        format!("spad.crosstalk_probability={}", [0.0, 0.2][seed as usize / 2 % 2]),
        format!("spad.dark_spread={}", [0.0, 1.0][seed as usize / 4 % 2]),
        format!("firmware.laser_freq={}", seed % 4),
        format!("firmware.pulse_half_cycles={}", [1, 1 + seed / 2 % 8][seed as usize % 2]),
        format!("firmware.mode={mode}"),
        format!("firmware.shots_per_frame={}", random.random_range(5..60)),
        format!("ambient.irradiance_w_m2_nm={}", [0.0, 0.05, 0.4][random.random_range(0..3)]),
        profile,
        calibration,
        format!("estimator.kind={kind}"),
        format!("seed={seed}"),
    ];
    let mut loaded = scenario::load(stimulus, &keys).unwrap();
    if !seed.is_multiple_of(3) {
        loaded.scenario.control = control(&mut random, cycles);
    }
    Setup::new(loaded).unwrap()
}

#[test]
fn every_module_skips_exactly_in_every_state_it_comes_through() {
    let (cycles, mut quiet) = (4_000, 0);
    for seed in 0..16 {
        let setup = random_setup(seed, cycles);
        let mut device = setup.device();
        device.power_up(&mut Off, &mut Off);
        for _ in 0..cycles {
            device.step(&setup.params, &mut Off, &mut Off);
            quiet += check_modules(&device.top, &setup);
        }
    }
    assert!(quiet > 16 * 4_000 * 5, "{quiet}");
}

#[test]
fn the_device_skips_exactly_in_every_state_it_comes_through() {
    let (cycles, mut skipped) = (4_000, 0);
    for seed in 0..16 {
        let setup = random_setup(seed, cycles);
        let mut device = setup.device();
        device.power_up(&mut Off, &mut Off);
        for _ in 0..cycles {
            device.step(&setup.params, &mut Off, &mut Off);
            let (mut short, mut long) = (device.clone(), device.clone());
            skip_idle(&mut short, &setup.params, device.cycle() + EDGES);
            while long.cycle() < short.cycle() {
                long.step(&setup.params, &mut Off, &mut Off);
                skipped += 1;
            }
            if short.cycle() > device.cycle() {
                assert_same_on_and_on(&short, &long, &setup.params, "skipped");
            }
        }
    }
    assert!(skipped > 30_000, "{skipped}");
}

#[test]
fn an_acquisition_is_the_same_with_its_halves_asleep() {
    let cycles = 4_000;
    let mut acquired = 0;
    for seed in 0..24 {
        let setup = random_setup(seed, cycles);
        let p = &setup.params;
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut device = setup.device();
        device.power_up(&mut Off, &mut Off);
        while device.cycle() < cycles {
            let limit = device.cycle() + random.random_range(1..60);
            let (mut fast, mut frames) = (device.clone(), [(); 2].map(|()| Frames::default()));
            acquire(&mut fast, p, &mut frames[0], limit, |_, _, _| {});
            acquired += fast.cycle() - device.cycle();
            while device.cycle() < fast.cycle() {
                device.step(p, &mut Off, &mut Off);
                frames[1].count_shot(&device.top);
                frames[1].count_hit(&device.top);
            }
            assert_same_on_and_on(&fast, &device, p, "acquired");
            assert_eq!(format!("{:?}", frames[0]), format!("{:?}", frames[1]));
            device.step(p, &mut Off, &mut Off);
        }
    }
    assert!(acquired > 25_000, "{acquired}");
}

#[test]
fn clear_and_an_estimation_come_to_the_same_leapt_over() {
    let (cycles, mut leaps) = (6_000, 0);
    for seed in 0..24 {
        let setup = random_setup(seed, cycles);
        let p = &setup.params;
        let mut device = setup.device();
        device.power_up(&mut Off, &mut Off);
        while device.cycle() < cycles {
            let mut leapt = device.clone();
            leap_frame_end(&mut leapt, p);
            if leapt.cycle() > device.cycle() {
                leaps += 1;
                let mut stepped = device.clone();
                // The TDC, whose window is closed, has seen the avalanches leapt over four edges later.
                let landed = leapt.cycle();
                for device in [&mut leapt, &mut stepped] {
                    while device.cycle() < landed + 4 {
                        device.step(p, &mut Off, &mut Off);
                    }
                }
                assert_same_on_and_on(&leapt, &stepped, p, "leapt over");
            }
            device.step(p, &mut Off, &mut Off);
        }
    }
    assert!(leaps > 100, "{leaps}");
}
