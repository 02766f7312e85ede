//! What a capture costs: `cargo bench --bench ila`. A frame without an analyser, then frames with
//! 64 probes into 131,072 samples, triggered in mid-frame; the frames take turns, so that both
//! sides see the same machine.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};

use tofsim::ila::{Analyser, Overrides, Plan, SetUp};
use tofsim::scenario;
use tofsim::sim::Run;
use tofsim::sim::run::Watch;
use tofsim::sim::setup::Setup;

/// Modules whose registers are probed, until there are 64.
const MODULES: &[&str] = &[
    "frame_ctrl",
    "vcsel_driver",
    "spad_control",
    "tdc.coarse_counter",
    "tdc.tdc_latch",
    "tdc.tdc_decoder",
    "depth_estimator.estimator_ctrl",
    "depth_estimator.forward1",
    "depth_estimator.forward2",
    "control_sync",
];

/// Samples of the capture.
const SAMPLES: u64 = 131_072;

fn set_up(setup: &Setup) -> SetUp {
    let mut text =
        format!("depth = {SAMPLES}\nposition = 65536\ntrigger = \"frame_ctrl.shots == 15000\"\n");
    let mut probes = 0;
    for module in MODULES {
        let scope = format!("tof_top.{module}");
        for entry in tofsim::hierarchy::entries(&setup.params) {
            if entry.scope == scope && entry.signal.width <= 64 && probes < 64 {
                text += &format!("[[probe]]\nsignal = \"{}\"\n", entry.path());
                probes += 1;
            }
        }
    }
    assert_eq!(probes, 64);
    SetUp::parse("bench", "bench.toml", &text, Overrides::default()).expect("the set-up is right")
}

fn without(setup: &Setup) -> Duration {
    let begun = Instant::now();
    black_box(Run::new(setup).frames(1, Watch::default()).expect("kc705 runs"));
    begun.elapsed()
}

fn with(setup: &Setup, plan: &Plan) -> Duration {
    let begun = Instant::now();
    let mut analyser = Analyser::new(plan, setup);
    Run::new(setup).capture(1, &mut analyser, None).expect("kc705 runs");
    assert!(analyser.is_full());
    black_box(analyser.finish());
    begun.elapsed()
}

fn captures(criterion: &mut Criterion) {
    let loaded = scenario::load(scenario::DEFAULT, &[]).expect("kc705 is built in");
    let setup = Setup::new(loaded).expect("kc705 can be set up");
    let plan = Plan::new(&set_up(&setup), &setup).expect("the probes are there");
    let mut group = criterion.benchmark_group("64 probes, 131072 samples");
    group.sample_size(30);
    group.bench_function("frame without", |bencher| {
        bencher.iter_custom(|frames| {
            (0..frames).map(|_| (without(&setup), with(&setup, &plan)).0).sum()
        });
    });
    group.bench_function("frame with", |bencher| {
        bencher.iter_custom(|frames| {
            (0..frames).map(|_| (without(&setup), with(&setup, &plan)).1).sum()
        });
    });
    group.finish();
}

criterion_group!(benches, captures);
criterion_main!(benches);
