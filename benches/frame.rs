//! What a frame costs: `cargo bench`. `cycles` is the rate in cycles of clk_125, `shots` in shots.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};

use tofsim::scenario;
use tofsim::sim::Run;
use tofsim::sim::run::Watch;
use tofsim::sim::setup::Setup;

fn frame(setup: &Setup) {
    let done = Run::new(setup).frames(1, setup, Watch::default());
    black_box(done.expect("a built-in scenario runs"));
}

fn frames(criterion: &mut Criterion) {
    for laser_freq in [3, 0] {
        let overrides = [format!("firmware.laser_freq={laser_freq}")];
        let loaded = scenario::load(scenario::DEFAULT, &overrides).expect("kc705 is built in");
        let setup = Setup::new(loaded).expect("kc705 can be set up");
        let mut group = criterion.benchmark_group(format!("frame at laser_freq {laser_freq}"));
        group.throughput(Throughput::Elements(setup.frame_cycles(laser_freq)));
        group.bench_function("cycles", |bencher| bencher.iter(|| frame(&setup)));
        group.throughput(Throughput::Elements(setup.scenario.firmware.shots_per_frame));
        group.bench_function("shots", |bencher| bencher.iter(|| frame(&setup)));
        group.finish();
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
