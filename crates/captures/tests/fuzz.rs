//! Fuzz tests: arbitrary bytes are an input or an error, and never cause a panic, a hang, or a large allocation.
//!
//! The cases are always the same, `PROPTEST_CASES` of them; with `TOFSIM_FUZZ_SECONDS` every test continues for that
//! long with other cases.

mod captures;
mod edit;
mod texts;
mod waves;

use std::fmt::Debug;
use std::time::{Duration, Instant};

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};

fn fuzz<T: Debug>(
    strategy: impl Strategy<Value = T>,
    test: impl Fn(T) -> Result<(), TestCaseError>,
) {
    let seconds = std::env::var("TOFSIM_FUZZ_SECONDS").ok();
    let seconds = seconds.map_or(0, |seconds| seconds.parse().expect("whole seconds"));
    let end = Instant::now() + Duration::from_secs(seconds);
    let config = Config { failure_persistence: None, ..Config::default() };
    let mut runner = match seconds {
        0 => TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha)),
        _ => TestRunner::new(config),
    };
    loop {
        runner.run(&strategy, &test).unwrap_or_else(|failure| panic!("{failure}"));
        if Instant::now() >= end {
            break;
        }
    }
}
