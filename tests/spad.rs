//! Tests of the SPAD's effects against closed forms: free running, and in the shots of a run.

use tofsim::optics::dark::dark_rate_hz;
use tofsim::optics::hazard::Cause;
use tofsim::sim::Run;
use tofsim::sim::fast::histogram::independent_shots;
use tofsim::sim::free_running::afterpulses::{Afterpulses, afterpulses};
use tofsim::sim::free_running::rates::rates;
use tofsim::sim::free_running::{FreeRunning, dark};
use tofsim::sim::run::Observers;
use tofsim::sim::shot_recorder::Shot;

use crate::common::setup;

fn diode(set: &[&str]) -> FreeRunning {
    FreeRunning::new(&setup("kc705", set))
}

#[test]
fn count_rates_are_those_of_the_closed_forms_over_four_decades() {
    for dead in ["spad.dead_time_ns=20", "spad.dead_time_ns=150"] {
        let points = rates(&diode(&[dead]), 20_000);
        assert!(points[8].incident_hz / points[0].incident_hz > 9_999.0);
        for point in points {
            for (counted, closed) in point.counted_hz.into_iter().zip(point.closed_form_hz) {
                let off = counted.deviations_from(closed);
                let incident_hz = point.incident_hz;
                assert!(off.abs() < 3.0, "{dead} {incident_hz:.3e}/s: {counted:?} {closed} {off}");
            }
            assert!(point.counted_hz[0].se < 0.01 * point.counted_hz[0].value);
        }
    }
}

#[test]
fn the_autocorrelation_gives_afterpulses_back() {
    for (p, ns) in [(0.05, 50.0), (0.3, 15.0), (0.02, 400.0), (0.0, 50.0)] {
        for kind in ["fixed", "paralysable"] {
            let keys = [
                format!("spad.afterpulse_probability={p}"),
                format!("spad.afterpulse_ns={ns}"),
                format!("spad.dead_time_kind={kind}"),
            ];
            let diode = diode(&keys.each_ref().map(String::as_str));
            let seen = afterpulses(&diode, 100.0, 60_000).unwrap();
            let expected = p * (-20.0f64 / ns).exp();
            assert!((seen.expected - expected).abs() < 1e-12);
            let what = format!("{p} {ns} {kind}: {seen:?}");
            assert!(seen.after_dead_time.deviations_from(expected).abs() < 3.5, "{what}");
            assert!(seen.after_dead_time.se < 0.003, "{what}");
            assert!(seen.tail_hz.deviations_from(seen.incident_hz).abs() < 3.5, "{what}");
            if p > 0.0 {
                let constant = seen.time_constant_s.unwrap();
                assert!(constant.deviations_from(ns * 1e-9).abs() < 3.5, "{what}");
                assert!(seen.probability.unwrap().deviations_from(p).abs() < 3.5, "{what}");
                // Every count has its afterpulses, and those have theirs.
                let rate_hz = seen.incident_hz / (1.0 - expected);
                assert!(seen.rate_hz.deviations_from(rate_hz).abs() < 3.5, "{what}");
            } else {
                assert!(seen.time_constant_s.is_none(), "{what}");
            }
        }
    }
}

/// Returns the deviation of pairs from the expected numbers: chi-square and degrees of freedom.
fn chi_square(seen: &Afterpulses) -> (f64, f64) {
    let cells =
        seen.pairs.iter().zip(&seen.expected_pairs).filter(|(_, expected)| **expected > 5.0);
    let cells: Vec<_> =
        cells.map(|(&pairs, expected)| (pairs as f64 - expected).powi(2) / expected).collect();
    (cells.iter().sum(), cells.len() as f64)
}

#[test]
fn with_traps_of_two_kinds_the_chance_after_the_dead_time_is_the_sum_of_both() {
    for (p, [first_ns, second_ns], share) in
        [(0.1, [50.0, 500.0], 0.3), (0.2, [15.0, 120.0], 0.5), (0.05, [300.0, 20.0], 0.6)]
    {
        let keys = [
            format!("spad.afterpulse_probability={p}"),
            format!("spad.afterpulse_ns={first_ns}"),
            format!("spad.afterpulse_second_ns={second_ns}"),
            format!("spad.afterpulse_second_share={share}"),
        ];
        let diode = diode(&keys.each_ref().map(String::as_str));
        let seen = afterpulses(&diode, 100.0, 100_000).unwrap();
        let [first, second] = [first_ns, second_ns].map(|ns: f64| (-20.0 / ns).exp());
        let expected = p * ((1.0 - share) * first + share * second);
        assert!((seen.expected - expected).abs() < 1e-12);
        let what = format!("{keys:?}: {seen:?}");
        assert!(seen.after_dead_time.deviations_from(expected).abs() < 3.5, "{what}");
        let mean_ns =
            p * ((1.0 - share) * first * first_ns + share * second * second_ns) / expected;
        assert!((seen.expected_time_s / mean_ns * 1e9 - 1.0).abs() < 1e-12, "{what}");
        let mean = seen.time_constant_s.unwrap();
        assert!(mean.deviations_from(mean_ns * 1e-9).abs() < 3.5, "{what}");
        assert_eq!(seen.probability, None, "a mean tells no probability");
        let (sum, cells) = chi_square(&seen);
        assert!(cells > 40.0 && sum < cells + 4.0 * (2.0 * cells).sqrt(), "{sum} {cells}: {what}");
    }
}

#[test]
fn the_autocorrelation_is_that_of_afterpulses_and_of_theirs() {
    for (p, ns) in [("0.3", "40"), ("0.6", "90")] {
        let keys = [format!("spad.afterpulse_probability={p}"), format!("spad.afterpulse_ns={ns}")];
        let diode = diode(&keys.each_ref().map(String::as_str));
        let (sum, cells) = chi_square(&afterpulses(&diode, 100.0, 100_000).unwrap());
        // Pairs of a family are not quite independent.
        assert!(sum < 1.5 * cells + 4.0 * (2.0 * cells).sqrt(), "{p} {ns}: {sum} of {cells}");
    }
}

#[test]
fn the_dark_rate_is_that_of_the_temperature() {
    for (temperature_c, expected_hz) in [("20", 100.0), ("60", 3200.0), ("-20", 3.125)] {
        // With few counts the last wait of a batch is a part of what is seen.
        for (p, counts) in [("0", 10_000), ("0.2", 10_000), ("0", 500)] {
            let keys = [
                format!("spad.temperature_c={temperature_c}"),
                format!("spad.afterpulse_probability={p}"),
            ];
            let setup = setup("kc705", &keys.each_ref().map(String::as_str));
            assert_eq!(setup.budget.dark_rate_hz, expected_hz);
            let dark_hz = dark_rate_hz(&setup.scenario.spad);
            let found = dark::dark_rate_hz(&FreeRunning::new(&setup), dark_hz, counts).unwrap();
            let off = found.deviations_from(expected_hz);
            assert!(off.abs() < 3.5, "{temperature_c} deg C: {found:?}");
        }
    }
    assert_eq!(dark::dark_rate_hz(&diode(&[]), 0.0, 10_000), None);
}

/// First avalanches of the shots of two frames, from the laser edge [ns], and their causes.
fn arrivals(keys: &[&str]) -> Vec<(f64, Cause)> {
    // So strong an echo that every shot has one, and nothing else.
    let scene = [
        "laser.average_power_w=1",
        "laser.pulse_sigma_ps=20",
        "target.reflectance=1",
        "ambient.irradiance_w_m2_nm=0",
        "spad.dark_rate_hz=0",
        "firmware.laser_freq=3",
        "spad.afterpulse_ns=30",
    ];
    let setup = setup("kc705", &[&scene, keys].concat());
    assert_eq!(setup.laser_period(), 6, "48 ns");
    let mut found = Vec::new();
    let mut see = |shot: &Shot| {
        if let (Some(fs), Some(cause)) = (shot.arrival_fs, shot.cause) {
            found.push((fs as f64 * 1e-6, cause));
        }
        Ok(())
    };
    let observers = Observers { shots: Some(&mut see), ..Observers::default() };
    Run::new(&setup).observe(2, observers).unwrap();
    found
}

#[test]
fn in_mode_0_afterpulses_come_before_the_echo_of_later_shots_as_often_as_they_should() {
    let p = 0.5;
    let shots = arrivals(&["spad.afterpulse_probability=0.5"]);
    assert!(shots.len() > 59_900, "{}", shots.len());
    let (early, echoes): (Vec<_>, Vec<_>) =
        shots.iter().partition(|(_, cause)| *cause == Cause::Afterpulse);
    let echo_ns = echoes.iter().map(|(ns, _)| ns).sum::<f64>() / echoes.len() as f64;
    assert!((3.0..3.4).contains(&echo_ns), "{echo_ns}");
    assert!(early.iter().all(|(ns, _)| (0.0..echo_ns + 0.1).contains(ns)), "after the reset fell");
    // Released in the shot after the avalanche, or in the one after that, and so on, and before the echo there.
    let chance = p * (echo_ns / 30.0f64).exp_m1() / (48.0 / 30.0f64).exp_m1();
    let expected = chance * shots.len() as f64;
    let off = (early.len() as f64 - expected) / expected.sqrt();
    assert!(off.abs() < 4.0, "{} for {expected}", early.len());
    assert!(arrivals(&[]).iter().all(|(_, cause)| *cause == Cause::Signal));
}

#[test]
fn a_frame_is_not_drawn_as_a_whole_with_afterpulses() {
    let of = |set: &[&str]| {
        let setup = setup("kc705", set);
        let refused = independent_shots(&setup, "who").err().map(|error| error.to_string());
        (refused, setup.has_separate_frames())
    };
    let (refused, apart) = of(&["spad.afterpulse_probability=0.01"]);
    assert!(refused.is_some_and(|why| why.contains("spad.afterpulse_probability = 0.01")));
    assert!(!apart);
    // In MODE 0 the first avalanche decides, whatever the others do.
    let row = ["spad.on_tdc=4", "spad.crosstalk_probability=0.3", "spad.dark_spread=1"];
    assert_eq!(of(&row), (None, true));
}
