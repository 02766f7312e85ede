//! Limits of the number of frames.

use tofsim::error::{Input, Result};
use tofsim::sim::setup::Setup;

use crate::text::table::grouped;

/// Cycles of a frame before its first shot and after its last, and some to spare [cycles of `clk_sys`].
const AROUND: u64 = 1000;
/// Bits of a frame's number in the random streams.
const NUMBER: u32 = 56;

/// Checks that simulated time lasts for so many frames, or pairs of them.
///
/// # Errors
/// When it does; the error names `option`.
pub fn check(option: &str, frames: u64, setup: &Setup) -> Result<()> {
    // Who controls the firmware may choose any rate.
    let slowest = setup.params.vcsel_driver.longest_period();
    let period = if setup.scenario.control.is_empty() { setup.laser_period() } else { slowest };
    let drain = setup.params.frame_ctrl.drain_cycles;
    let cycles = AROUND + drain + setup.shots(1) * period;
    let most = u64::MAX / (cycles * setup.cycle().fs()) / setup.frames_together();
    let reason = "simulated time, in 64 bits of femtoseconds, ends after five hours";
    within(option, frames, most, reason)
}

/// Checks the number of frames that take no simulated time.
///
/// # Errors
/// When there are more than have random numbers of their own; the error names `option`.
pub fn check_streams(option: &str, frames: u64, setup: &Setup) -> Result<()> {
    let most = (1 << NUMBER) / setup.frames_together();
    let reason = "no more have random numbers of their own";
    within(option, frames, most, reason)
}

fn within(option: &str, frames: u64, most: u64, reason: &str) -> Result<()> {
    if frames <= most {
        return Ok(());
    }
    let expected = format!("expected {} at most: {reason}", grouped(most));
    Err(Input::new(option, expected).value(frames).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::scenario;

    fn setup(set: &[&str]) -> Setup {
        let set: Vec<_> = set.iter().map(|set| set.to_string()).collect();
        Setup::new(scenario::load("kc705", &set).unwrap()).unwrap()
    }

    #[test]
    fn frames_that_would_outlast_time_are_refused_with_the_reason() {
        let setup = setup(&[]);
        check("--frames", 10_000_000, &setup).unwrap();
        let error = check("--frames", u64::MAX, &setup).unwrap_err().to_string();
        assert!(error.starts_with("--frames: 18446744073709551615: expected 1"), "{error}");
        assert!(error.contains("ends after five hours"), "{error}");
        check_streams("--frames", 1 << 56, &setup).unwrap();
        assert!(check_streams("--frames", (1 << 56) + 1, &setup).is_err());
    }

    #[test]
    fn pairs_slow_lasers_and_control_leave_time_for_fewer() {
        let most = |set: &[&str]| {
            let setup = setup(set);
            (0..64).map(|k| 1 << k).take_while(|&n| check("n", n, &setup).is_ok()).last().unwrap()
        };
        assert_eq!(most(&["firmware.dark_frames=true"]), most(&[]));
        assert!(most(&["firmware.laser_freq=0"]) < most(&[]));
        assert!(most(&["control=[{at_us=1,mode=0}]"]) < most(&[]));
    }
}
