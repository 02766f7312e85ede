//! Benchmark of a capture: `cargo bench --bench ila`. Frames without an analyser alternate with frames with 64 probes
//! and 131,072 samples, so that both see the same machine load.
//!
//! The probes cover the whole chain: control signals, states, counts, addresses, the code on its way to the
//! histogram, histogram words around the target, and the depth; 319 bits from nearly every module. The trigger is in
//! the middle of the frame, with half of the samples before it. If it is armed from the start, the analyser evaluates
//! every cycle up to the trigger.

use std::hint::black_box;
use std::time::Instant;

use tofsim::scenario;
use tofsim::sim::Run;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim_captures::ila::{Analyser, AnalyserPlan, AnalyserSetup, capture};

/// Modules with their probed signals.
const PROBES: &[(&str, &str)] = &[
    ("", "rst tdc_stop mode laser_freq laser_en dsp_en dsp_rst"),
    ("", "rst_dsp tdc_code tdc_valid count"),
    ("pll", "locked"),
    ("reset_sync_sys", "rst_sync"),
    ("reset_sync_laser", "rst_sync"),
    ("control_sync", "mode_sync laser_freq_sync laser_en_sync dsp_en_sync dsp_rst_sync"),
    ("frame_ctrl", "clear clear_addr acquire algo_start frame_done state shots drain"),
    ("vcsel_driver", "pre_start start fire count last enable laser_pulse laser_on"),
    ("spad_control", "spad_rst spad_sel"),
    ("tdc.coarse_counter", "coarse window"),
    ("tdc.tdc_latch", "hit hit_coarse used tap_0_last"),
    ("tdc.tdc_decoder", "tdc_valid tdc_code n_valid n n_coarse"),
    ("histogram_builder", "ram_131 ram_132 ram_133 ram_134 ram_135"),
    ("depth_estimator.estimator_ctrl", "read_en read_addr rom_addr forward1_en tansig_en"),
    ("depth_estimator.estimator_ctrl", "forward2_en neuron algo_done busy step"),
    ("depth_estimator.forward2", "depth"),
];

/// Laser rate, and arming time of the analyser [us].
const CASES: &[(u64, u64)] = &[(3, 0), (0, 0), (0, 2_450)];

/// Number of pairs of frames.
const PAIRS: usize = 41;

fn set_up(arm_at_us: u64) -> AnalyserSetup {
    let mut text = format!(
        "depth = 131072\nposition = 65536\narm_at_us = {arm_at_us}\n\
         trigger = \"frame_ctrl.shots == 15000\"\n"
    );
    for (module, signals) in PROBES {
        for signal in signals.split(' ') {
            let path = if module.is_empty() { signal.into() } else { format!("{module}.{signal}") };
            text += &format!("[[probe]]\nsignal = \"{path}\"\n");
        }
    }
    AnalyserSetup::parse("bench", "bench.toml", &text).expect("the set-up is right")
}

/// Times of a frame without an analyser and of one with it.
struct Pair {
    /// Time of the frame without analyser [ms].
    without: f64,
    /// Time of the frame with analyser, without `finish` [ms].
    with: f64,
    /// Time of `finish` [ms].
    finish: f64,
    /// Number of samples that the analyser evaluated.
    looks: u64,
}

impl Pair {
    fn measure(setup: &Setup, plan: &AnalyserPlan) -> Self {
        let begun = Instant::now();
        black_box(Run::new(setup).observe(1, Observers::default()).expect("kc705 runs"));
        let without = ms_since(begun);
        let begun = Instant::now();
        let mut analyser = Analyser::new(plan, setup);
        capture(Run::new(setup), 1, &mut analyser, None).expect("kc705 runs");
        let with = ms_since(begun);
        assert!(analyser.is_full());
        let looks = analyser.taken();
        let begun = Instant::now();
        black_box(analyser.finish());
        Pair { without, with, finish: ms_since(begun), looks }
    }
}

fn ms_since(begun: Instant) -> f64 {
    begun.elapsed().as_secs_f64() * 1e3
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let measures = std::env::args().any(|argument| argument == "--bench");
    let pairs = if measures { PAIRS } else { 1 };
    println!("laser_freq  armed at   looks at   without      with    finish   ratio  with finish");
    for &(laser_freq, arm_at_us) in CASES {
        let overrides = [format!("firmware.laser_freq={laser_freq}")];
        let loaded = scenario::load(scenario::DEFAULT, &overrides).expect("kc705 is built in");
        let setup = Setup::new(loaded).expect("kc705 can be set up");
        let plan = AnalyserPlan::new(&set_up(arm_at_us), &setup).expect("the probes are there");
        assert_eq!(plan.probes.len(), 64);
        let pairs: Vec<_> = (0..pairs).map(|_| Pair::measure(&setup, &plan)).collect();
        let of = |value: fn(&Pair) -> f64| median(pairs.iter().map(value));
        println!(
            "{laser_freq:10}  {arm_at_us:5} us  {:9}  {:5.2} ms  {:5.2} ms  {:5.2} ms  {:6.3}  {:11.3}",
            pairs[0].looks,
            of(|pair| pair.without),
            of(|pair| pair.with),
            of(|pair| pair.finish),
            of(|pair| pair.with / pair.without),
            of(|pair| (pair.with + pair.finish) / pair.without),
        );
    }
}
