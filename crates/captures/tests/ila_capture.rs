//! Tests of the logic analyser in a simulation, from configuration to capture.

use bitvec::prelude::*;

use tofsim::kernel::Time;
use tofsim::sim::Run;
use tofsim::sim::setup::Setup;
use tofsim_captures::ila::{Analyser, AnalyserPlan, AnalyserSetup, Capture, sampler};

use crate::common::{self, empty, setup};

/// Returns the capture after some frames, and the times of its triggers.
fn capture(setup: &Setup, text: &str, frames: u64) -> (Capture, Vec<Time>) {
    let set_up = AnalyserSetup::parse("t", "t.toml", text).unwrap();
    let mut analyser = Analyser::new(&AnalyserPlan::new(&set_up, setup).unwrap(), setup);
    sampler::capture(Run::new(setup), frames, &mut analyser, None).unwrap();
    let triggers = analyser.triggers();
    (analyser.finish(), triggers)
}

/// Returns the values of a probe.
fn values(capture: &Capture, name: &str) -> Vec<u64> {
    let probe = capture.probes.iter().position(|probe| probe.name == name).expect(name);
    let place = capture.places().nth(probe).unwrap();
    (0..capture.samples()).map(|s| capture.sample(s)[place.clone()].load_le()).collect()
}

/// Returns the samples at which a value becomes 1.
fn rises(values: &[u64]) -> Vec<usize> {
    (1..values.len()).filter(|&k| values[k] == 1 && values[k - 1] == 0).collect()
}

fn built_in(name: &str) -> (Capture, Vec<Time>) {
    let set_up = AnalyserSetup::load(name).unwrap();
    let set: Vec<_> = set_up.file.set.iter().map(String::as_str).collect();
    let setup = setup(&set_up.file.scenario, &set);
    let mut analyser = Analyser::new(&AnalyserPlan::new(&set_up, &setup).unwrap(), &setup);
    sampler::capture(Run::new(&setup), set_up.file.frames, &mut analyser, None).unwrap();
    assert!(analyser.is_full(), "{name}");
    let triggers = analyser.triggers();
    let capture = analyser.finish();
    let samples = set_up.file.depth as usize;
    assert_eq!((capture.samples(), triggers.len()), (samples, 1), "{name}");
    (capture, triggers)
}

/// A short frame of photons.
fn short() -> Setup {
    setup("kc705", &["firmware.shots_per_frame=200"])
}

#[test]
fn fig_6_6_shows_the_laser_in_the_second_half_of_the_reset() {
    let (capture, triggers) = built_in("fig_6_6");
    let (laser, reset) = (values(&capture, "VCSEL_ON"), values(&capture, "SPAD_RST_DO"));
    assert_eq!((laser[511], laser[512], reset[510], reset[511], reset[513]), (0, 1, 0, 1, 0));
    let rises = rises(&laser);
    let mut periods: Vec<_> = rises.windows(2).map(|pair| pair[1] - pair[0]).collect();
    periods.dedup();
    assert_eq!(periods, [12], "two samples of 4 ns for each cycle of clk_sys");
    assert!(triggers[0] > Time::from_ns(1000));
}

#[test]
fn fig_6_12_reads_a_code_from_the_rom_two_edges_after_the_laser_s() {
    let (capture, _) = built_in("fig_6_12");
    let (laser, valid) = (values(&capture, "VCSEL_ON"), values(&capture, "TDC_VALID"));
    let later: Vec<_> = rises(&laser).iter().map(|at| at + 2).filter(|&at| at < 1024).collect();
    assert_eq!(rises(&valid), later);
    assert!(later.len() > 30);
}

#[test]
fn fig_6_13_ends_with_the_counts_that_the_list_of_codes_has() {
    let (capture, _) = built_in("fig_6_13");
    let list = include_str!("../../../stimuli/codes/kc705.csv");
    let mut codes: Vec<&str> = list.lines().filter(|line| !line.starts_with('#')).collect();
    codes.remove(0);
    for bin in 0..7 {
        let count = codes.iter().filter(|&&code| code == bin.to_string()).count() as u64;
        let counts = values(&capture, &format!("COUNTS[{bin}]"));
        assert_eq!(counts.last(), Some(&count), "bin {bin}");
    }
    let clock = values(&capture, "CLK_125");
    assert!(clock.windows(2).all(|pair| pair[0] != pair[1]), "it turns at every sample");
}

#[test]
fn fig_6_21_shows_the_three_steps_and_the_depth() {
    let (capture, _) = built_in("fig_6_21");
    let high = |name| values(&capture, name)[..16 + 268].iter().sum::<u64>();
    let steps = ["FORWARD1_EN", "TANSIG_EN", "FORWARD2_EN"].map(high);
    assert_eq!(steps, [256, 1, 4]);
    let (done, depth) = (values(&capture, "ALGO_DONE"), values(&capture, "Depth"));
    let at = done.iter().position(|&level| level == 1).unwrap();
    assert_eq!(at, 16 + 265, "the first sum begins two cycles after e0");
    let frame = &common::frames(&setup("estimator_validation", &[]), 1)[0];
    assert_eq!(depth[at], frame.words.depth.bits());
    let start = values(&capture, "FORWARD2_EN").iter().position(|&level| level == 1).unwrap();
    assert_eq!(start, 16 + 260);
    assert_eq!(capture.probes.iter().filter(|p| p.head().starts_with("L1_IN[")).count(), 8);
}

#[test]
fn likelihood_estimator_shows_where_each_step_leads_and_what_comes_out() {
    let (capture, _) = built_in("likelihood_estimator");
    let of = |name| values(&capture, name);
    let (steps, done) = (of("STEPS"), of("ALGO_DONE"));
    let at = done.iter().position(|&level| level == 1).unwrap();
    assert_eq!((of("ALGO_START")[16], at), (1, 16 + 3780), "a cycle until it is taken");
    let setup = setup("estimator_validation", &["estimator.kind=likelihood"]);
    let histogram = &common::frames(&setup, 1)[0].histogram;
    let params = setup.likelihood(setup.params.frame_ctrl.shots_per_frame.into()).unwrap();
    let expected = tofsim::sim::estimates::likelihood::trace(&params, histogram);
    let words = ["ARRIVAL", "STRENGTH", "AMBIENT", "CUT"].map(of);
    for (taken, (point, information)) in (1..).zip(expected.steps) {
        let sample = steps.iter().position(|&steps| steps == taken).unwrap();
        let wanted = [point.arrival, point.signal, point.ambient, information.cut.into()];
        let found = [0, 1, 2, 3].map(|word: usize| words[word][sample] as i64);
        assert_eq!(found, wanted, "step {taken}");
    }
    let found = expected.found;
    let wanted = [
        found.words().depth.bits(),
        found.sigma as u64,
        found.status.bits().into(),
        found.chi_square as u64,
        1,
    ];
    let ends = ["Depth", "SIGMA", "STATUS", "CHI_SQUARE", "VALID"].map(|name| of(name)[at]);
    assert_eq!(ends, wanted);
}

const SHOTS: &str = "
    [[probe]]
    name = \"start\"
    signal = \"vcsel_driver.start\"
    [[probe]]
    signal = \"frame_ctrl.shots\"
    [[probe]]
    signal = \"tdc.tdc_decoder.tdc_code[7:4]\"
";

#[test]
fn several_windows_have_a_trigger_each() {
    let text = format!("windows = 8\nposition = 3\ntrigger = \"start rising\"{SHOTS}");
    let (capture, triggers) = capture(&short(), &text, 1);
    assert_eq!(capture.windows, [0, 128, 256, 384, 512, 640, 768, 896]);
    assert_eq!(capture.triggers, capture.windows.iter().map(|at| at + 3).collect::<Vec<_>>());
    let start = values(&capture, "start");
    assert!(capture.triggers.iter().all(|&at| start[at] == 1 && start[at - 1] == 0));
    // 128 samples of a window and three more before the next: 22 shots of 6 cycles.
    let spans: Vec<_> = triggers.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert_eq!(spans, [Time::from_ns(22 * 6 * 8); 7]);
}

#[test]
fn windows_of_any_number_are_the_largest_power_of_two_that_fits() {
    let text = format!("windows = 3\ntrigger = \"start\"{SHOTS}");
    let (capture, _) = capture(&short(), &text, 1);
    assert_eq!((capture.samples(), capture.windows), (768, vec![0, 256, 512]));
}

#[test]
fn only_samples_that_qualify_are_stored() {
    let qualified = format!("position = 0\ncapture = \"start\"\ntrigger = \"start\"{SHOTS}");
    let (capture, _) = capture(&short(), &qualified, 8);
    assert!(values(&capture, "start").iter().all(|&start| start == 1));
    let shots = values(&capture, "frame_ctrl/shots");
    assert_eq!(shots[..5], [0, 1, 2, 3, 4]);
}

#[test]
fn an_edge_qualifies_one_sample() {
    let text = format!("clock = \"clk_laser\"\nposition = 0\ncapture = \"start rising\"{SHOTS}");
    let shots = &values(&capture(&short(), &text, 1).0, "frame_ctrl/shots")[1..];
    assert!(shots.len() > 100, "{shots:?}");
    assert!(shots.windows(2).all(|pair| pair[1] == pair[0] + 1), "{shots:?}");
}

#[test]
fn the_trigger_may_be_a_signal_that_is_no_probe() {
    let text = format!("position = 0\ntrigger = \"frame_ctrl.acquire falling\"{SHOTS}");
    let (capture, _) = capture(&short(), &text, 1);
    assert_eq!(values(&capture, "frame_ctrl/shots")[0], 200);
    for trigger in ["clk_in", "tdc.carry_chain.taps[100]"] {
        let text = format!("position = 0\ntrigger = \"{trigger} rising\"{SHOTS}");
        assert_eq!(self::capture(&short(), &text, 1).1.len(), 1, "{trigger}");
    }
}

#[test]
fn the_analyser_does_not_look_before_it_is_armed() {
    let text = |arm_at_us: f64| {
        format!("position = 0\narm_at_us = {arm_at_us}\ntrigger = \"start rising\"{SHOTS}")
    };
    let first = capture(&short(), &text(0.0), 1).1[0];
    let us = |time: Time| time.seconds() * 1e6;
    assert_eq!(capture(&short(), &text(us(first) - 0.012), 1).1[0], first);
    let next = Time::from_ns(6 * 8);
    assert_eq!(capture(&short(), &text(us(first) + 0.001), 1).1[0], first + next);
    let free = |arm| format!("clock = \"125 MHz\"\n{}", text(arm));
    let first = capture(&short(), &free(0.0), 1).1[0];
    assert_eq!(capture(&short(), &free(us(first) + 0.001), 1).1[0], first + next);
}

#[test]
fn input_stages_shift_everything_by_so_many_edges() {
    let text = |stages| {
        format!(
            "input_stages = {stages}\nposition = 9\narm_at_us = 3.2\n\
             trigger = \"frame_ctrl.shots == 20\"{SHOTS}"
        )
    };
    let (direct, at) = capture(&short(), &text(0), 1);
    for stages in [1, 6] {
        let (late, late_at) = capture(&short(), &text(stages), 1);
        assert_eq!(late.words, direct.words);
        assert_eq!(late_at[0] - at[0], Time::from_ns(8 * stages));
    }
    // From the first edge on: zeros, then what the first edge took.
    let locked = "input_stages = 3\nposition = 0\n[[probe]]\nsignal = \"pll.locked\"";
    let (capture, at) = capture(&short(), locked, 1);
    assert_eq!(values(&capture, "pll/locked")[..5], [0, 0, 0, 1, 1]);
    assert_eq!(at[0], short().pll().clk_sys.rise(0));
}

/// Returns a configuration with about `count` signals of a design, depending on `seed`.
fn some_probes(setup: &Setup, count: usize, seed: usize) -> String {
    let mut entries = tofsim::hierarchy::entries(&setup.params);
    entries.extend(tofsim::hierarchy::ram_entries(&setup.params.histogram));
    entries.retain(|entry| entry.signal.name != "clk_in");
    let preloaded = entries.iter().all(|entry| entry.scope != "tof_top.histogram_builder");
    entries.retain(|entry| !preloaded || !entry.signal.name.starts_with("ram_"));
    let step = (entries.len() / count).max(1);
    let mut text = String::new();
    for entry in entries.iter().skip(seed % step).step_by(step) {
        text += &format!("[[probe]]\nsignal = \"{}\"\n", entry.path());
    }
    text
}

const OSCILLATOR: &str = "[[probe]]\nname = \"last\"\nsignal = \"clk_in\"\n";

#[test]
fn looking_at_edges_only_is_looking_at_every_change() {
    for (seed, scenario) in
        ["kc705", "bright", "spad_validation", "tdc_validation", "histogram_validation"]
            .into_iter()
            .enumerate()
    {
        for (clock, arm_at_us) in [("clk_sys", 0.0), ("clk_laser", 2.9)] {
            let overrides = ["firmware.shots_per_frame=120", "pll.jitter_rms_ps=7.7"];
            let photons = scenario == "tdc_validation";
            let setup = setup(scenario, if photons { &[] } else { &overrides });
            let head = format!(
                "clock = \"{clock}\"\ndepth = 2048\narm_at_us = {arm_at_us}\nposition = 0\n\
                 trigger = \"vcsel_driver.start rising || frame_ctrl.acquire falling\"\n"
            );
            let probes = some_probes(&setup, 40, seed);
            let (edges, edges_at) = capture(&setup, &format!("{head}{probes}"), 1);
            let (full, full_at) = capture(&setup, &format!("{head}{probes}{OSCILLATOR}"), 1);
            assert!(edges.samples() > 100, "{scenario}");
            assert_eq!(edges_at, full_at, "{scenario} {clock}");
            for sample in 0..edges.samples() {
                let width = edges.width();
                let same = edges.sample(sample)[..width] == full.sample(sample)[..width];
                assert!(same, "{scenario} {clock} sample {sample}");
            }
            let last = values(&full, "last");
            assert!(last.contains(&0) && last.contains(&1), "clk_in is seen");
        }
    }
}

#[test]
fn a_free_clock_with_the_edges_of_clk_sys_takes_the_same_samples() {
    let setup = setup("bright", &["firmware.shots_per_frame=100"]);
    let first_ps = setup.pll().clk_sys.rise(0).ps();
    let text = |clock: &str| {
        let probes = some_probes(&setup, 60, 3);
        format!("clock = \"{clock}\"\nposition = 5\ntrigger = \"tdc.tdc_valid\"\n{probes}")
    };
    let (design, design_at) = capture(&setup, &text("clk_sys"), 1);
    let (free, free_at) = capture(&setup, &text(&format!("125 MHz + {first_ps} ps")), 1);
    assert_eq!(design_at, free_at);
    assert_eq!(design.words, free.words);
    let (later, _) = capture(&setup, &text(&format!("125 MHz + {} ps", first_ps + 1)), 1);
    assert_ne!(design.words, later.words, "a picosecond later the edge has passed");
}

#[test]
fn clk_in_sees_itself_low_and_the_others_move() {
    let text = "clock = \"clk_in\"\nposition = 0\n[[probe]]\nsignal = \"clk_in\"\n\
        [[probe]]\nsignal = \"pll.locked\"\n[[probe]]\nsignal = \"pll.clk_sys\"";
    let (capture, at) = capture(&short(), text, 1);
    assert!(values(&capture, "clk_in").iter().all(|&level| level == 0));
    assert_eq!(at[0], Time::from_fs(2_500_000), "half a period after power-up");
    // Locked at 1000 ns; edge 199 comes at 997.5 ns.
    assert_eq!(rises(&values(&capture, "pll/locked")), [200]);
    assert!(rises(&values(&capture, "pll/clk_sys")).len() > 50);
}

/// A photon exactly on a clock edge reaches the detector with it; the edge has not seen it.
#[test]
fn a_change_exactly_at_an_edge_is_seen_by_the_next() {
    let setup = setup("spad_validation", &[]);
    // Control changes at 6.3 us, which is no edge; at 8.0 us is one of clk_sys.
    let folder = empty();
    let path = folder.path().join("edge.toml");
    let first = setup.pll().clk_sys.rise(100);
    let text = format!("[[control]]\nat_us = {}\nmode = 1\n", first.seconds() * 1e6);
    std::fs::write(&path, text).unwrap();
    let setup = common::setup(path.to_str().unwrap(), &["firmware.shots_per_frame=40"]);
    for (clock, probe) in [("clk_sys", ""), ("clk_sys", OSCILLATOR), ("clk_laser", "")] {
        let text =
            format!("clock = \"{clock}\"\nposition = 0\n[[probe]]\nsignal = \"mode\"\n{probe}");
        let (capture, _) = capture(&setup, &text, 1);
        let edges = if clock == "clk_laser" { 200 } else { 100 };
        let mode = values(&capture, "mode");
        assert_eq!((mode[edges], mode[edges + 1]), (0, 1), "{clock}");
    }
    let text = format!(
        "clock = \"1 GHz + {} ps\"\nposition = 0\narm_at_us = {}\n[[probe]]\nsignal = \"mode\"",
        0,
        first.seconds() * 1e6 - 0.002
    );
    let (capture, _) = capture(&setup, &text, 1);
    assert_eq!(values(&capture, "mode")[..5], [0, 0, 0, 1, 1]);
}
