//! Benchmark of a frame: `cargo bench`. An iteration of `cycle` is one cycle of clk_sys, so that its time is in
//! nanoseconds per cycle; `shots` reports shots per second.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};

use tofsim::scenario;
use tofsim::sim::Run;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;

fn frame(setup: &Setup) -> u64 {
    let done = Run::new(setup).observe(1, Observers::default());
    black_box(done.expect("a built-in scenario runs")).cycles
}

/// Measures the time of `cycles` cycles, in whole frames that contain at least as many.
fn time_of_cycles(setup: &Setup, cycles: u64) -> Duration {
    let (begun, mut done) = (Instant::now(), 0);
    while done < cycles {
        done += frame(setup);
    }
    begun.elapsed().mul_f64(cycles as f64 / done as f64)
}

fn frames(criterion: &mut Criterion) {
    for laser_freq in [3, 0] {
        let overrides = [format!("firmware.laser_freq={laser_freq}")];
        let loaded = scenario::load(scenario::DEFAULT, &overrides).expect("kc705 is built in");
        let setup = Setup::new(loaded).expect("kc705 can be set up");
        let mut group = criterion.benchmark_group(format!("laser_freq {laser_freq}"));
        group.bench_function("cycle", |bencher| {
            bencher.iter_custom(|cycles| time_of_cycles(&setup, cycles));
        });
        group.throughput(Throughput::Elements(setup.scenario.firmware.shots_per_frame));
        group.bench_function("shots", |bencher| bencher.iter(|| frame(&setup)));
        group.finish();
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
