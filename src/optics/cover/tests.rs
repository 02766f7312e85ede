//! Tests of a window's light against sums of a few lines, of what is not shared with the code.

use statrs::function::erf::erf;

use super::*;
use crate::kernel::Time;
use crate::optics::hazard::{Cause, Hazard};
use crate::optics::{BinProbabilities, Bins, Budget};

const C: f64 = 299_792_458.0;

fn scenario(change: impl FnOnce(&mut Scenario)) -> Scenario {
    let mut scenario = Scenario::default();
    scenario.cover.fraction = 1e-4;
    change(&mut scenario);
    scenario
}

fn budget(scenario: &Scenario) -> Budget {
    Budget::new(scenario, Pulse::default())
}

fn assert_close(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() < relative, "{found} for {expected}");
}

/// Phi, by another library than the code's.
fn phi(z: f64) -> f64 {
    0.5 * (1.0 + erf(z / 2f64.sqrt()))
}

/// A part of a pulse of `sigma` after a normal delay, and a part of that after an exponential one, by midpoints.
fn come(t: f64, at: f64, [sigma, width]: [f64; 2], [smeared, tau]: [f64; 2]) -> f64 {
    let normal = |t: f64| phi((t - at) / sigma.hypot(width));
    let step = tau / 200.0;
    let late = |k: i32| (f64::from(k) + 0.5) * step;
    let tail: f64 =
        (0..4000).map(|k| step / tau * (-late(k) / tau).exp() * normal(t - late(k))).sum();
    (1.0 - smeared) * normal(t) + smeared * tail
}

#[test]
fn a_windows_photons_are_its_part_of_the_pulse_through_filter_lens_and_spad() {
    let expected = |fraction: f64, sensors: f64| {
        let photons = fraction * (7.36e-3 / 40e6) / (6.626_070_15e-34 * C / 940e-9);
        // The square array in the round image of the lens.
        photons * 0.67 * 0.8 * (2.0 / std::f64::consts::PI / 40.0) * 0.012 * 0.25 * sensors
    };
    assert_close(budget(&scenario(|_| ())).cover_per_shot, expected(1e-4, 1.0), 1e-12);
    let four = scenario(|s| s.spad.on_tdc = 4);
    assert_close(budget(&four).cover_per_shot, expected(1e-4, 4.0), 1e-12);
    let warm = scenario(|s| {
        (s.spad.temperature_c, s.cover.temperature_coefficient_per_k) = (30.0, 0.02);
        (s.cover.dirt_per_h, s.cover.age_h) = (1e-6, 50.0);
    });
    assert_close(budget(&warm).cover_per_shot, expected(1.2e-4 + 5e-5, 1.0), 1e-12);
    assert_eq!(budget(&scenario(|s| s.cover.fraction = 0.0)), budget(&Scenario::default()));
}

#[test]
fn the_hazard_is_that_of_echo_and_window_added_up() {
    for (width_ps, smeared, smear_ps) in [
        (0.0, 0.0, 300.0),
        (80.0, 0.0, 300.0),
        (0.0, 0.4, 250.0),
        (150.0, 0.7, 900.0),
        (0.0, 1.0, 40.0),
    ] {
        for reflectance in [0.34, 0.02] {
            let scenario = scenario(|s| {
                s.target.reflectance = reflectance;
                s.laser.delay_ps = 1100.0;
                (s.cover.delay_ps, s.cover.width_ps) = (250.0, width_ps);
                (s.cover.smear_fraction, s.cover.smear_ps) = (smeared, smear_ps);
            });
            let budget = budget(&scenario);
            let hazard = Hazard::new(&budget);
            let noise = budget.background_rate_hz() * 1e-12;
            for k in 1..400 {
                let t = 20.0 * f64::from(k);
                let echo = phi((t - 1100.0 - 1e12 / C) / 137.0);
                let window = come(t, 1350.0, [137.0, width_ps], [smeared, smear_ps]);
                let [echo, window] =
                    [budget.signal_per_shot * echo, budget.cover_per_shot * window];
                let found = hazard.at(Time::from_ps_f64(t));
                let expected = noise * t + echo + window;
                let most = 1e-4 * budget.laser_per_shot();
                assert!((found - expected).abs() < most, "{found} for {expected} at {t} ps");
            }
        }
    }
}

#[test]
fn a_window_takes_photons_of_the_echo_and_none_of_them_is_its_own() {
    let scenario = scenario(|s| {
        (s.cover.fraction, s.laser.delay_ps) = (4e-4, 1500.0);
        (s.ambient.irradiance_w_m2_nm, s.spad.dark_rate_hz) = (0.0, 0.0);
    });
    let budget = budget(&scenario);
    let (hazard, bins) =
        (Hazard::new(&budget), Bins::even(Time::ZERO, Time::from_ps_f64(50.0), 400));
    let none = |photons: f64| (-photons).exp();
    let end = Time::from_ns(20);
    // The echo comes when all of the window's light has: it needs a shot without a photon of that.
    let left = none(budget.cover_per_shot) * (1.0 - none(budget.signal_per_shot));
    assert_close(hazard.signal_first(end), left, 1e-6);
    let counted: f64 = BinProbabilities::new(&hazard, &bins).of_code()[60..].iter().sum();
    assert_close(counted, left, 1e-3);
    // The same by the causes of what comes when.
    let at = |ps: f64, uniform: f64| hazard.cause(Time::from_ps_f64(ps), uniform);
    assert_eq!((at(1600.0, 1e-6), at(1600.0, 0.999_999)), (Cause::Cover, Cause::Cover));
    assert_eq!((at(4835.0, 0.0), at(4835.0, 0.999_999)), (Cause::Signal, Cause::Signal));
    let [signal, _, _, cover] = hazard.by_cause(Time::ZERO, end);
    assert_close(signal, budget.signal_per_shot, 1e-9);
    assert_close(cover, budget.cover_per_shot, 1e-9);
}

#[test]
fn what_the_pulse_would_put_before_the_laser_edge_is_the_windows() {
    let scenario = scenario(|s| (s.cover.fraction, s.cover.delay_ps) = (1e-3, 0.0));
    let hazard = Hazard::new(&budget(&scenario));
    assert_eq!(hazard.cause(Time::ZERO, 0.999), Cause::Cover);
    assert_eq!(hazard.varied([0.0; 2]).cause(Time::ZERO, 0.999), Cause::Cover);
    assert!(hazard.signal_first(Time::from_ps_f64(1000.0)) < 1e-9);
}
