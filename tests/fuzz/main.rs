//! Any bytes are an input or an error, never a panic, a hang, or much memory.
//!
//! `PROPTEST_CASES` sets the number of cases; with `TOFSIM_FUZZ_SECONDS` every test goes on for
//! that long.

#[path = "../ila/fixtures.rs"]
mod fixtures;
#[path = "../ila/mod.rs"]
mod ila;

mod captures;
mod edit;
mod texts;
mod waves;

use std::fmt::Debug;
use std::time::{Duration, Instant};

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, TestCaseError, TestRunner};

fn fuzz<T: Debug>(
    strategy: impl Strategy<Value = T>,
    test: impl Fn(T) -> Result<(), TestCaseError>,
) {
    let seconds = std::env::var("TOFSIM_FUZZ_SECONDS").ok();
    let seconds = seconds.map_or(0, |seconds| seconds.parse().expect("whole seconds"));
    let end = Instant::now() + Duration::from_secs(seconds);
    let mut runner = TestRunner::new(Config { failure_persistence: None, ..Config::default() });
    loop {
        runner.run(&strategy, &test).unwrap_or_else(|failure| panic!("{failure}"));
        if Instant::now() >= end {
            break;
        }
    }
}
