//! Fast ways change nothing: however a scenario is run, its frames are those of the plain step.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use proptest::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use tofsim::firmware::pll::Pll;
use tofsim::scenario::{self, Control, QuenchMode};
use tofsim::sim::frames::Frame;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim::sim::shot_recorder::Shot;
use tofsim::sim::{Run, Stepping};
use tofsim::{Note, WaveFormat};

use crate::common;

/// Result of a run.
#[derive(Debug, PartialEq)]
struct Result {
    frames: Vec<Frame>,
    end_fs: u64,
    cycles: u64,
    shots: u64,
    notes: Vec<Note>,
}

#[derive(Clone, Copy, Debug)]
enum Way {
    /// Every shot is followed, so that every cycle is stepped.
    Followed,
    OneByOne(Stepping),
    OnTwoThreads(Stepping),
}

fn run(setup: &Setup, count: u64, way: Way) -> Result {
    let mut frames = Vec::new();
    let mut take = |frame: &Frame| {
        frames.push(frame.clone());
        Ok(())
    };
    let mut see = |_: &Shot| Ok(());
    let observers = Observers { frames: Some(&mut take), ..Observers::default() };
    let run = Run::new(setup);
    let outcome = match way {
        Way::Followed => run.observe(count, Observers { shots: Some(&mut see), ..observers }),
        Way::OneByOne(stepping) => run.stepping(stepping).observe(count, observers),
        Way::OnTwoThreads(stepping) => run.stepping(stepping).many(count, observers),
    };
    let outcome = outcome.unwrap();
    let (end_fs, cycles, shots) = (outcome.end.fs(), outcome.cycles, outcome.shots);
    Result { frames, end_fs, cycles, shots, notes: outcome.notes }
}

/// Compares what each fidelity gives, on one thread and on two, with what the plain step gives.
pub fn assert_all_alike(setup: &Setup, count: u64) -> std::result::Result<(), TestCaseError> {
    static THREADS: LazyLock<ThreadPool> =
        LazyLock::new(|| ThreadPoolBuilder::new().num_threads(2).build().unwrap());
    let plain = run(setup, count, Way::OneByOne(Stepping::EveryCycle));
    for way in [
        Way::Followed,
        Way::OneByOne(Stepping::SkipIdle),
        Way::OneByOne(Stepping::LeapShots),
        Way::OnTwoThreads(Stepping::SkipIdle),
        Way::OnTwoThreads(Stepping::LeapShots),
    ] {
        let found = THREADS.install(|| run(setup, count, way));
        prop_assert_eq!(&found, &plain, "{:?}", way);
    }
    Ok(())
}

/// A random scenario: keys, control changes, photons and a chain of its own.
#[derive(Clone, Debug)]
struct Case {
    keys: Vec<String>,
    control: Vec<(u64, i64, u8)>,
    /// Photons: shot, edge of clk_sys after the laser's, and how long after that one [fs].
    photons: Option<Vec<(u64, u64, i64)>>,
    /// Delays of a chain [fs].
    chain: Option<(u32, Vec<i64>)>,
    /// Width of the registers' set-up window [ps].
    window_ps: u8,
    /// Temperatures at power-up and some time later.
    heats: Option<[u8; 2]>,
    /// Whether every other frame is dark.
    pairs: bool,
    frames: u64,
    clock: &'static str,
}

fn keys() -> impl Strategy<Value = Vec<String>> {
    let scene = (0.05..1.5f64, 0.01..1.0f64, prop_oneof![Just(0.0), 0.0..1.0f64]);
    let light = (
        prop_oneof![Just(137.0), 1.0..2000.0f64],
        prop_oneof![Just(100.0), Just(0.0), 0.0..1e9f64],
    );
    let firmware = (0..4u8, 0..4u8, 1..70u16, 0..10u8);
    let chain = prop_oneof![Just("uniform"), Just("table6_3"), Just("ideal"), Just("kintex7")];
    (scene, light, firmware, chain, 0..5u8, any::<u32>()).prop_map(
        |(
            (distance, reflectance, ambient),
            (sigma, dark),
            (freq, mode, shots, laser),
            chain,
            jitter,
            seed,
        )| {
            vec![
                format!("target.distance_m={distance:?}"),
                format!("target.reflectance={reflectance:?}"),
                format!("ambient.irradiance_w_m2_nm={ambient:?}"),
                format!("laser.pulse_sigma_ps={sigma:?}"),
                format!("laser.pulse_tail_ps={}", if seed % 4 == 1 { 90 } else { 0 }),
                format!("laser.delay_ps={}", [0, 0, 900, 30_000][seed as usize / 1024 % 4]),
                format!("laser.timing_jitter_ps={}", if seed % 5 == 1 { 150 } else { 0 }),
                format!("laser.energy_jitter={}", if seed % 5 < 2 { 0.3 } else { 0.0 }),
                format!("spad.dark_rate_hz={dark:?}"),
                format!(
                    "spad.afterpulse_probability={}",
                    [0.0, 0.6, 0.05, 0.0][seed as usize / 16 % 4]
                ),
                format!("spad.afterpulse_ns={}", [20, 400][seed as usize / 64 % 2]),
                format!("spad.afterpulse_second_share={}", [0.0, 0.4][seed as usize / 2048 % 2]),
                format!(
                    "spad.dead_time_kind={}",
                    ["fixed", "paralysable"][seed as usize / 128 % 2]
                ),
                format!("spad.temperature_c={}", 20 + seed / 256 % 2 * 30),
                format!("firmware.laser_freq={freq}"),
                format!("firmware.mode={}", u8::from(mode == 3)),
                format!("firmware.shots_per_frame={shots}"),
                format!("firmware.laser_en={}", laser > 0),
                format!("tdc.profile=\"{chain}\""),
                format!("tdc.calibration={}", ["true", "uniform"][usize::from(jitter == 1)]),
                format!(
                    "tdc.decoder={}",
                    ["ones", "leading", "reordered"][seed as usize / 512 % 3]
                ),
                format!("pll.jitter_rms_ps={}", if jitter == 0 { 7.7 } else { 0.0 }),
                format!("estimator.kind={}", if seed % 3 == 0 { "centroid" } else { "network" }),
                format!("seed={seed}"),
            ]
        },
    )
}

/// Photons of the first shots, many of them exactly on edges or where an edge just sees them.
fn photons() -> impl Strategy<Value = Vec<(u64, u64, i64)>> {
    let offset =
        prop_oneof![Just(0), Just(2_230_000), Just(2_236_000), Just(2_000_000), Just(2_158_000)];
    let near = prop_oneof![Just(-1i64), Just(0), Just(1)];
    let on_edge = (0..26u64, offset, near).prop_map(|(edge, before, near)| (edge, near - before));
    let arrival = prop_oneof![on_edge, (Just(0), 0..210_000_000i64)];
    let photon = (0..120u64, arrival).prop_map(|(shot, (edge, after_fs))| (shot, edge, after_fs));
    prop::collection::vec(photon, 0..80)
}

/// 800 delays, some of them negative: taps that are not reached in order.
fn chain() -> impl Strategy<Value = (u32, Vec<i64>)> {
    let delays = prop::collection::vec(-8_000..28_000i64, 800);
    (200_000..9_000_000u32, delays)
}

prop_compose! {
    fn case()(
        keys in keys(),
        control in prop_oneof![
            2 => Just(Vec::new()),
            3 => prop::collection::vec((0..4000u64, prop_oneof![Just(0), -8_000_000..8_000_000i64], 0..12u8), 1..8),
        ],
        photons in prop::option::weighted(0.25, photons()),
        chain in prop::option::weighted(0.25, chain()),
        window_ps in prop_oneof![4 => Just(0), 1 => 1..6u8],
        heats in prop::option::weighted(0.2, [15..60u8, 15..60u8]),
        pairs in prop::bool::weighted(0.25),
        frames in 1..6u64,
        clock in prop_oneof![3 => Just(0), 1 => 1..4usize],
    ) -> Case {
        Case {
            keys, control, photons, chain, window_ps, heats, pairs, frames, clock: common::CLOCKS[clock],
        }
    }
}

/// A change of one signal near an edge of `clk_sys`.
fn change(&(edge, offset_fs, what): &(u64, i64, u8), pll: &Pll) -> Control {
    let at_fs = pll.clk_sys.rise(edge).fs().saturating_add_signed(offset_fs);
    let mut change = Control { at_us: at_fs as f64 / 1e9, ..Control::default() };
    match what {
        0..=3 => change.laser_freq = Some(what.into()),
        4 => change.mode = Some(QuenchMode::EachShot),
        5 => change.mode = Some(QuenchMode::FreeRunning),
        6 | 7 => change.laser_en = Some(what == 7),
        8 => change.dsp_en = Some(false),
        9 => change.dsp_rst = Some(true),
        10 => change.rst = Some(true),
        _ => change.dsp_en = Some(true),
    }
    change
}

/// The timeline, with everything that holds a frame up let go some time later.
fn timeline(changes: &[(u64, i64, u8)], pll: &Pll) -> Vec<Control> {
    let mut timeline: Vec<_> = changes.iter().map(|it| change(it, pll)).collect();
    for &(edge, offset, what) in changes {
        let mut after = change(&(edge + 1 + u64::from(what) * 9, offset, 8), pll);
        after.dsp_en = (what == 8).then_some(true);
        after.dsp_rst = (what == 9).then_some(false);
        after.rst = (what == 10).then_some(false);
        timeline.push(after);
    }
    timeline.sort_by(|a, b| a.at_us.total_cmp(&b.at_us));
    timeline
}

/// `None` where the scenario is refused: a chain may be too long.
fn set_up(case: &Case, folder: &Path) -> Option<Setup> {
    let mut keys = case.keys.clone();
    keys.push(case.clock.to_owned());
    let clocks = scenario::load("kc705", &[case.clock.to_owned()]).unwrap();
    let pll = Pll::new(&clocks.scenario.pll.params());
    if let Some(photons) = &case.photons {
        let mut text = "shot,arrival_ps\n".to_owned();
        let arrival = |edge: u64, after_fs| (edge * pll.cycle.fs()).saturating_add_signed(after_fs);
        let photons = photons.iter().map(|&(shot, edge, after_fs)| (shot, arrival(edge, after_fs)));
        let mut photons: Vec<_> = photons.collect();
        photons.sort_unstable();
        for (shot, fs) in photons {
            writeln!(text, "{shot},{}.{:03}", fs / 1000, fs % 1000).unwrap();
        }
        let path = folder.join("photons.csv");
        fs::write(&path, text).unwrap();
        keys.push(format!("stimulus.photons={:?}", path.display().to_string()));
    }
    if let Some((offset_fs, delays)) = &case.chain {
        let delays: Vec<_> = delays.iter().map(|fs| *fs as f64 / 1e3).collect();
        let text =
            format!("offset_ps = {:?}\ntap_delays_ps = {delays:?}\n", f64::from(*offset_fs) / 1e3);
        let path = folder.join("chain.toml");
        fs::write(&path, text).unwrap();
        keys.push(format!("tdc.profile={:?}", path.display().to_string()));
    }
    keys.push(format!("tdc.setup_window_ps={}", case.window_ps));
    if let Some([from_c, to_c]) = case.heats {
        let path = folder.join("conditions.csv");
        let rows = format!("2e-6,{from_c},0\n6e-5,{to_c},1\n");
        fs::write(&path, format!("time_s,temperature_c,supply_mv\n{rows}")).unwrap();
        keys.push(format!("tdc.conditions={:?}", path.display().to_string()));
    }
    let mut loaded = scenario::load("kc705", &keys).unwrap();
    let scenario = &mut loaded.scenario;
    scenario.control = timeline(&case.control, &pll);
    if case.pairs {
        (scenario.firmware.dark_frames, scenario.firmware.laser_en) = (true, true);
        scenario.firmware.shots_per_frame *= 2;
        scenario.control.retain(|change| change.laser_en.is_none());
    }
    Setup::new(loaded).ok()
}

fn every_way_gives_the_same(case: &Case) -> std::result::Result<(), TestCaseError> {
    let folder = tempfile::tempdir().unwrap();
    let Some(setup) = set_up(case, folder.path()) else {
        let may_be_refused =
            case.chain.is_some() || case.heats.is_some() || case.clock != common::CLOCKS[0];
        prop_assert!(may_be_refused, "only a chain may be refused");
        return Err(TestCaseError::reject("the chain does not fit the clock"));
    };
    assert_all_alike(&setup, case.frames)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_way_gives_the_same_in_random_scenarios(case in case()) {
        every_way_gives_the_same(&case)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    #[ignore = "long: ./check --full"]
    fn every_way_gives_the_same_in_many_random_scenarios(case in case()) {
        every_way_gives_the_same(&case)?;
    }
}

#[test]
fn every_way_gives_the_same_for_whole_frames() {
    for name in [
        "kc705",
        "bright",
        "far",
        "near",
        "spad_validation",
        "tdc_validation",
        "histogram_validation",
        "estimator_validation",
    ] {
        for freq in [0, 3] {
            let setup = common::setup(name, &[&format!("firmware.laser_freq={freq}")]);
            assert_all_alike(&setup, 1).unwrap();
        }
    }
}

/// An avalanche may come in the cycle in which a frame ends.
#[test]
fn frames_with_a_waveform_are_those_without_it() {
    let folder = tempfile::tempdir().unwrap();
    let setup = common::setup("kc705", &["firmware.shots_per_frame=300", "firmware.mode=1"]);
    let mut frames = Vec::new();
    let mut take = |frame: &Frame| {
        frames.push(frame.clone());
        Ok(())
    };
    let waves = setup.waves(&folder.path().join("a.vcd"), WaveFormat::Vcd, &["start"]).unwrap();
    let waves = Some((waves, setup.windows(&[], 40).unwrap()));
    let observers = Observers { waves, frames: Some(&mut take), ..Observers::default() };
    Run::new(&setup).observe(40, observers).unwrap();
    assert_eq!(frames, Run::new(&setup).frames(40).unwrap());
}

/// A shot may begin with what a SPAD that resets itself has left in the chain.
#[test]
fn every_way_gives_the_same_wherever_the_quench_mode_changes() {
    // So that the SPAD is armed again at about every second laser edge.
    let scene = ["firmware.mode=1", "ambient.irradiance_w_m2_nm=0.05", "target.reflectance=0.3"];
    for freq in 0..4 {
        let freq = format!("firmware.laser_freq={freq}");
        for edge in 280..310 {
            let at_us = 1.008 + 0.008 * f64::from(edge);
            let control = format!("control=[{{at_us={at_us},mode=0}}]");
            let short = ["firmware.shots_per_frame=40", &freq, &control];
            for seed in 0..12 {
                let seed = format!("seed={seed}");
                let setup = common::setup("kc705", &[&scene[..], &short, &[&seed]].concat());
                assert_all_alike(&setup, 1).unwrap();
            }
        }
    }
}
