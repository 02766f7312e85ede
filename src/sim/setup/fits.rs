//! Whether the sizes of the firmware fit each other: what its chain asks of laser periods, of Drain, and of the ring
//! that calibrates it.

use crate::error::{Input, Result};
use crate::firmware::tdc;
use crate::firmware::tof_top::{CodeSource, Params};
use crate::firmware::vcsel_driver::PERIOD_RANGE;
use crate::kernel::Time;
use crate::sensor::ring;

/// Clock cycles that codes have to be apart, so that each comes to its word of the histogram.
const CODES_APART: u64 = 3;
/// From the edge that makes a code to the one after which its word may be read, and from the end of Drain to
/// the first read: what Drain has to have beside a hit's way to its code [cycles of clk_sys].
const TO_ITS_WORD: u64 = 1;
/// Deviations by which half a period of a ring may be short.
const SPARE: f64 = 8.0;

/// Refuses a laser period in which the code of a late photon would come too close to that of an early one of
/// the next shot, and a Drain in which the last photon would not come to its word.
///
/// # Errors
/// The key, its value, and one that would fit.
pub(super) fn check(scenario: &str, params: &Params) -> Result<()> {
    let fault = |key: String, value: u64, expected: String| {
        Err(Input::new(format!("scenario {scenario}"), expected).field(key).value(value).into())
    };
    let CodeSource::Tdc = params.code_source else { return Ok(()) };
    let last = params.tdc.last_coded();
    // From a hit at the first edge after the laser's to one at the last.
    let spread = last.saturating_sub(1);
    let least = (spread + CODES_APART).max(*PERIOD_RANGE.start());
    for (rate, &period) in params.vcsel_driver.periods.iter().enumerate() {
        if period < least {
            let expected = format!(
                "expected {least} cycles or more: photons with a code come up to {last} edges after the laser's"
            );
            return fault(format!("firmware.laser_periods.{rate}"), period, expected);
        }
    }
    let least = last + params.tdc.decoder.latency() + TO_ITS_WORD;
    let drain = params.frame_ctrl.drain_cycles;
    if drain < least {
        let expected =
            format!("expected {least} cycles or more: the last photon's way to its word");
        return fault("firmware.drain_cycles".to_owned(), drain, expected);
    }
    Ok(())
}

/// Refuses a ring of which two edges would be in the chain at once, or hide between two edges of the clock, and a
/// chain that hits reach so late that their age has no word; in a run its delays are up to `slowest` times as long.
///
/// # Errors
/// The key, its value, and one that would fit.
pub(super) fn check_ring(
    scenario: &str,
    ring: &ring::Params,
    tdc: &tdc::Params,
    slowest: f64,
) -> Result<()> {
    let fault = |key: &str, expected: String| {
        Input::new(format!("scenario {scenario}"), expected).field(key)
    };
    let at_most = |age: Time| Time::from_fs((age.fs() as f64 * slowest).ceil() as u64);
    let period = tdc.decoder.scale.period();
    let (longest, tap_0) = (at_most(tdc.delays.longest()), at_most(tdc.delays.tap_0()));
    if tap_0 > period {
        let (ps, most) = (tap_0.fs() as f64 * 1e-3, period.fs() as f64 * 1e-3);
        let expected = format!(
            "expected a chain that hits reach within a clock period of {most} ps, to calibrate it"
        );
        return Err(fault("tdc.profile", expected).value(format!("{ps} ps")).into());
    }
    let spare = Time::from_fs((SPARE * ring.jitter_fs).round() as u64);
    let least = longest.max(period) + spare;
    if ring.half <= least {
        let [own, least] = [ring.half, least].map(|half| 2.0 * half.fs() as f64 * 1e-6);
        let expected = format!(
            "expected more than {least} ns: half a period lasts longer than the chain and than a clock period"
        );
        return Err(fault("tdc.ring_ns", expected).value(own).into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::sim::run::Run;
    use crate::sim::setup::Setup;

    fn error(overrides: &[&str]) -> String {
        Setup::load("kc705", overrides).unwrap_err().to_string()
    }

    #[test]
    fn a_drain_too_short_is_refused_with_the_shortest_that_will_do() {
        let message = error(&["firmware.drain_cycles=9"]);
        assert!(message.contains("firmware.drain_cycles = 9: expected 10 cycles"), "{message}");
        let message = error(&["firmware.drain_cycles=8", "tdc.count_stages=2"]);
        assert!(message.contains("expected 9 cycles"), "{message}");
    }

    #[test]
    fn the_shortest_drain_loses_no_photon() {
        let histograms = |drain: &str| -> Vec<_> {
            let late = ["target.distance_m=0.9", "firmware.shots_per_frame=3", drain];
            let setup = Setup::load("kc705", &late).unwrap();
            let frames = Run::new(&setup).frames(300).unwrap();
            frames.into_iter().map(|frame| frame.histogram).collect()
        };
        let usual = histograms("firmware.drain_cycles=16");
        assert!(usual.iter().any(|histogram| histogram[230..].iter().any(|&count| count > 0)));
        // The light of a frame does not depend on when it begins.
        assert!(histograms("firmware.drain_cycles=10") == usual);
    }
}
