//! Tests of averages over shots against closed forms, and of shots without deviation against plain ones.

use crate::optics::Budget;

use super::*;
use crate::kernel::pulse::normal_cdf;
use crate::scenario::Laser;

fn varying(timing_jitter_ps: f64, energy_jitter: f64) -> Variation {
    Variation::of(&Laser { timing_jitter_ps, energy_jitter, ..Laser::default() })
}

fn budget(background_hz: f64, signal: f64, mean_ps: u64) -> Budget {
    Budget {
        signal_per_shot: signal,
        ambient_rate_hz: background_hz,
        mean_arrival: Time::from_fs(mean_ps * 1000),
        ..Budget::default()
    }
}

/// Integrates the signal rate times the probability of no earlier avalanche by the midpoint rule with steps of 0.05
/// ps, for the exact pulse.
fn integrated(budget: &Budget, until_ps: f64) -> f64 {
    let sigma = budget.pulse.sigma_ps();
    let place = |ps: f64| (ps - budget.mean_arrival.fs() as f64 / 1e3) / sigma;
    let density = |ps: f64| (-0.5 * place(ps).powi(2)).exp() / (2.5066282746 * sigma);
    let none_before = |ps: f64| {
        let hazard = budget.background_rate_hz() * ps * 1e-12
            + budget.signal_per_shot * normal_cdf(place(ps));
        (-hazard).exp()
    };
    let step = 0.05;
    let steps = (until_ps / step) as u64;
    let middles = (0..steps).map(|k| (k as f64 + 0.5) * step);
    let after: f64 = middles.map(|ps| density(ps) * none_before(ps) * step).sum();
    budget.signal_per_shot * after + 1.0 - none_before(0.0)
}

#[test]
fn it_is_the_integral_of_the_exact_pulse() {
    for (background_hz, signal, mean_ps) in
        [(0.952e9, 39.4, 667), (0.27e9, 0.89, 3336), (2e9, 5.0, 200), (100.0, 0.14, 4003)]
    {
        let budget = budget(background_hz, signal, mean_ps);
        let hazard = Hazard::new(&budget);
        for until_ps in [600, 3400, 6400, 40_000] {
            let expected = integrated(&budget, until_ps as f64);
            let found = hazard.signal_first(Time::from_fs(until_ps * 1000));
            assert!((found - expected).abs() < 2e-5, "{budget:?}: {found} {expected}");
        }
    }
}

#[test]
fn without_background_every_avalanche_is_a_laser_photons() {
    let hazard = Hazard::new(&budget(0.0, 0.89, 3336));
    let expected = 1.0 - (-0.89f64).exp();
    assert!((hazard.signal_first(Time::from_ns(100)) - expected).abs() < 1e-12);
}

#[test]
fn without_signal_none_is() {
    let lit = budget(1e9, 5.0, 3336);
    assert_eq!(Hazard::dark(&lit).signal_first(Time::from_ns(100)), 0.0);
    assert_eq!(Hazard::new(&lit).signal_first(Time::ZERO), 0.0);
    assert!(Hazard::new(&lit).signal_first(Time::from_ns(2)) < 1e-12, "before the echo");
}

/// Scenes: bright, dim, without background, and so near that the pulse is cut off.
const SCENES: [(f64, f64, u64); 4] =
    [(0.9e9, 39.4, 667), (0.27e9, 0.89, 3336), (0.0, 0.14, 4003), (1e9, 5.0, 200)];

#[test]
fn a_shot_of_the_mean_is_the_plain_one() {
    for (background_hz, signal, mean_ps) in SCENES {
        let hazard = Hazard::new(&budget(background_hz, signal, mean_ps));
        let shot = hazard.varied([0.0; 2]);
        for k in 0..20_000 {
            let t = Time::from_fs(k * 500);
            assert!((shot.at(t) - hazard.at(t)).abs() < 1e-9, "{t}");
            let h = k as f64 * 0.003;
            let [own, plain] = [shot.inverse(h), hazard.inverse(h)];
            assert!(own == plain || own.fs().abs_diff(plain.fs()) < 3, "{h}: {own} {plain}");
            let draw = k as f64 / 20_000.0;
            assert_eq!(shot.cause(t, draw), hazard.cause(t, draw), "{t}");
        }
        let until = Time::from_ns(5);
        assert!((hazard.signal_first(until) - shot.signal_first(until)).abs() < 1e-12);
    }
}

#[test]
fn a_late_or_strong_shot_is_a_plain_one_of_another_scene() {
    for (background_hz, signal, mean_ps) in SCENES {
        let variation = varying(50.0, 0.2);
        let hazard = Hazard::new(&Budget { variation, ..budget(background_hz, signal, mean_ps) });
        let other = Hazard::new(&budget(background_hz, 1.3 * signal, mean_ps + 100));
        let shot = hazard.varied([2.0, 1.5]);
        for k in 1..20_000 {
            let t = Time::from_fs(k * 500);
            assert!((shot.at(t) - other.at(t)).abs() < 1e-9, "{t}");
            let h = k as f64 * 0.003;
            let [own, plain] = [shot.inverse(h), other.inverse(h)];
            assert!(own == plain || own.fs().abs_diff(plain.fs()) < 3, "{h}: {own} {plain}");
        }
        let without = hazard.varied([0.0, -7.0]);
        let dark = Hazard::dark(&budget(background_hz, 0.0, mean_ps));
        let t = Time::from_ns(6);
        assert_eq!((without.at(t), without.inverse(0.4)), (dark.at(t), dark.inverse(0.4)));
    }
}

#[test]
fn a_mean_over_shots_is_that_of_normal_numbers() {
    let variation = varying(300.0, 0.1);
    let hazard = Hazard::new(&Budget { variation, ..budget(0.0, 2.0, 3336) });
    let moments = [1, 2, 4].map(|power| {
        hazard.mean(|shot| ((shot.time(0) - hazard.first.time) * 1e-3 / 300.0).powi(power))
    });
    assert!(moments[0].abs() < 1e-12);
    assert!((moments[1] - 1.0).abs() < 1e-6 && (moments[2] - 3.0).abs() < 1e-5, "{moments:?}");
    assert!((hazard.mean(|shot| shot.signal) - 2.0).abs() < 1e-12);
}
