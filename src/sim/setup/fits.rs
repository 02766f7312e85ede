//! Checks that the sizes of the firmware fit each other: the chain with laser periods, Drain, pulses, and the ring that
//! calibrates it.

use crate::error::{Input, Result};
use crate::firmware::carry_chain::MAX_TRANSITIONS;
use crate::firmware::tdc;
use crate::firmware::tof_top::{CodeSource, Params};
use crate::firmware::vcsel_driver::PERIOD_RANGE;
use crate::kernel::Time;
use crate::scenario::{QuenchMode, Scenario};
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

/// Refuses dead times and pulses so short that more changes of `tdc_stop` could travel in the chain at once than it
/// shows. In MODE 0 there is one rise a shot.
///
/// # Errors
/// The key, its value, and what would fit.
pub(super) fn check_pulses(scenario: &str, keys: &Scenario, longest: Time) -> Result<()> {
    let spad = &keys.spad;
    let begins = QuenchMode::FreeRunning;
    let changes = keys.control.iter().any(|change| change.mode == Some(begins));
    if keys.firmware.mode != begins && !changes {
        return Ok(());
    }
    // An output is high for a dead time at least, so that rises are as far apart; one more change than there is room
    // for comes half as many rises later.
    let least_ns = longest.fs() as f64 * 1e-6 / (MAX_TRANSITIONS / 2) as f64;
    let shaped_ns = spad.pulse_ns + spad.pulse_gap_ns;
    if spad.dead_time_ns.max(shaped_ns) >= least_ns {
        return Ok(());
    }
    let (key, value, what) = if spad.pulse_ns > 0.0 {
        ("spad.pulse_ns", spad.pulse_ns, " with spad.pulse_gap_ns, or such a spad.dead_time_ns")
    } else {
        ("spad.dead_time_ns", spad.dead_time_ns, "")
    };
    let expected = format!(
        "expected {least_ns} ns or more{what}: a chain of {} ns shows {MAX_TRANSITIONS} changes at once",
        longest.fs() as f64 * 1e-6,
    );
    Err(Input::new(format!("scenario {scenario}"), expected).field(key).value(value).into())
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
    use super::check_pulses;
    use crate::kernel::Time;
    use crate::sim::run::Run;
    use crate::sim::setup::Setup;

    fn error(overrides: &[&str]) -> String {
        Setup::load("kc705", overrides).unwrap_err().to_string()
    }

    #[test]
    fn pulses_of_which_more_would_travel_in_the_chain_than_it_shows_are_refused() {
        let check = |longest_ns: u64, keys: &[&str]| {
            let setup = Setup::load("kc705", keys).unwrap();
            let longest = Time::from_ns(longest_ns);
            let refused = check_pulses("s", &setup.scenario, longest).err();
            refused.map(|error| error.to_string()).unwrap_or_default()
        };
        let free = ["firmware.mode=1", "spad.dead_time_ns=10"];
        let with = |more: &[&str]| check(60, &[&free, more].concat());
        let message = with(&[]);
        assert!(
            message.contains("spad.dead_time_ns = 10: expected 15 ns or more: a chain of 60 ns"),
            "{message}"
        );
        let message = with(&["spad.pulse_ns=6", "spad.pulse_gap_ns=8"]);
        assert!(message.contains("spad.pulse_ns = 6: expected 15 ns or more with"), "{message}");
        assert_eq!(with(&["spad.pulse_ns=6", "spad.pulse_gap_ns=9"]), "");
        assert_eq!(check(40, &free), "", "rises are 10 ns apart");
        assert_eq!(check(60, &free[1..]), "", "one rise a shot");
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
