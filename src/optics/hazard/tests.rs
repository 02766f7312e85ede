//! Tests of the hazard and its inverse against the exact functions.

use crate::kernel::pulse::{Pulse, Samples, normal_cdf};
use crate::scenario::Laser;

use super::*;

fn budget(background_hz: f64, signal: f64, mean_ps: u64, sigma_ps: f64) -> Budget {
    Budget {
        signal_per_shot: signal,
        ambient_rate_hz: background_hz,
        mean_arrival: Time::from_fs(mean_ps * 1000),
        pulse: Pulse::Gaussian { sigma_ps },
        ..Budget::default()
    }
}

/// Scenes: bright and near, typical, wide and before the laser edge, narrow, dim, without background.
const SCENES: [(f64, f64, u64, f64); 7] = [
    (0.952e9, 39.4, 667, 137.0),
    (0.27e9, 0.89, 3336, 137.0),
    (3e9, 5.0, 667, 2000.0),
    (1e9, 1.0, 4000, 1.0),
    (100.0, 0.14, 4003, 137.0),
    (0.0, 0.14, 4003, 137.0),
    (0.0, 39.4, 500, 137.0),
];

fn scenes() -> impl Iterator<Item = (Budget, Hazard)> {
    SCENES.iter().map(|&(n, s, mean_ps, sigma_ps)| {
        let budget = budget(n, s, mean_ps, sigma_ps);
        let hazard = Hazard::new(&budget);
        (budget, hazard)
    })
}

fn sigmas(budget: &Budget, t: Time) -> f64 {
    (t.fs() as f64 - budget.mean_arrival.fs() as f64) / (budget.pulse.sigma_ps() * 1e3)
}

fn exact(budget: &Budget, t: Time) -> f64 {
    budget.background_rate_hz() * t.seconds()
        + budget.signal_per_shot * normal_cdf(sigmas(budget, t))
}

/// Returns times within `reach` sigma of the mean, and after the laser edge.
fn times(budget: &Budget, reach: f64) -> impl Iterator<Item = Time> {
    let (mean_ps, sigma_ps) = (budget.mean_arrival.ps() as f64, budget.pulse.sigma_ps());
    (0..10_007)
        .map(move |k| mean_ps + (k as f64 / 5003.0 - 1.0) * reach * sigma_ps)
        .filter(|&ps| ps > 0.002)
        .map(Time::from_ps_f64)
}

#[test]
fn the_hazard_is_within_1e_5_of_the_signal() {
    let mut worst = 0.0f64;
    for (budget, hazard) in scenes() {
        for t in times(&budget, 12.0) {
            let error = (hazard.at(t) - exact(&budget, t)).abs() / budget.signal_per_shot;
            worst = worst.max(error);
        }
    }
    assert!((5e-6..7.5e-6).contains(&worst), "{worst:e}");
}

#[test]
fn an_arrival_is_within_a_4000th_of_sigma() {
    let mut worst = 0.0f64;
    for (budget, hazard) in scenes() {
        let sigma_fs = budget.pulse.sigma_ps() * 1e3;
        for t in times(&budget, 7.0).filter(|&t| sigmas(&budget, t) < 5.0) {
            let found = hazard.inverse(exact(&budget, t)).fs() as f64;
            let error = (found - t.fs() as f64).abs() - 1.0;
            worst = worst.max(error / sigma_fs);
        }
    }
    assert!((1e-4..2.5e-4).contains(&worst), "{worst:e}");
}

#[test]
fn an_arrival_and_its_hazard_agree_to_the_femtosecond() {
    for (budget, hazard) in scenes() {
        for k in 1..50_000 {
            let h = k as f64 / 10_000.0;
            let t = hazard.inverse(h);
            if t == Time::NEVER {
                assert!(budget.background_rate_hz() == 0.0 && h >= budget.signal_per_shot);
                continue;
            }
            let next = t + Time::from_fs(1);
            assert!(hazard.at(t) <= h * (1.0 + 1e-12), "{h} {t}");
            assert!(hazard.at(next) >= h * (1.0 - 1e-12), "{h} {t}");
        }
    }
}

#[test]
fn what_would_come_before_the_laser_edge_arrives_at_it() {
    let hazard = Hazard::new(&budget(1e9, 39.4, 667, 137.0));
    let jump = hazard.at(Time::from_fs(1)) - 1e9 * 1e-15;
    assert!((jump / (39.4 * normal_cdf(-667.0 / 137.0)) - 1.0).abs() < 1e-3, "{jump:e}");
    assert_eq!(hazard.at(Time::ZERO), 0.0);
    assert_eq!(hazard.inverse(0.0), Time::ZERO);
    assert_eq!(hazard.inverse(0.99 * jump), Time::ZERO);
    assert!(hazard.inverse(1.1 * jump) > Time::ZERO);
    assert_eq!(hazard.cause(Time::ZERO, 0.9), Cause::Signal);
}

#[test]
fn a_delayed_pulse_is_the_same_pulse_later_in_the_same_background() {
    let laser = Laser { timing_jitter_ps: 80.0, energy_jitter: 0.2, ..Laser::default() };
    let variation = Variation::of(&laser);
    let later = Time::from_fs(2_345_678);
    for variation in [Variation::default(), variation] {
        let own = Budget { variation, ..budget(0.27e9, 3.0, 3336, 137.0) };
        let [own, late] = [Time::ZERO, later].map(|delay| {
            Hazard::new(&Budget { mean_arrival: own.mean_arrival + delay, ..own.clone() })
        });
        let between = 0.27e9 * later.seconds();
        for ps in (2_000..6_000).step_by(7) {
            let t = Time::from_fs(ps * 1000 + 1);
            let (expected, found) = (own.at(t) + between, late.at(t + later));
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} for {expected} at {t}");
            let wait = (late.inverse(found), own.inverse(expected - between) + later);
            assert!(wait.0.max(wait.1) - wait.0.min(wait.1) < Time::from_fs(20), "{wait:?}");
            let [expected, found] =
                [own.varied([0.5, -1.0]).at(t), late.varied([0.5, -1.0]).at(t + later)];
            assert!((found / (expected + between) - 1.0).abs() < 1e-9, "{found} at {t}");
        }
    }
}

#[test]
fn without_light_the_dark_rate_remains() {
    let mut dark = budget(0.0, 0.0, 3336, 137.0);
    dark.dark_rate_hz = 100.0;
    for hazard in [Hazard::new(&dark), Hazard::dark(&budget(100.0, 5.0, 3336, 137.0))] {
        assert_eq!(hazard.inverse(1.0).ps(), 10_000_000_000);
        assert!((hazard.at(Time::from_ns(1_000_000)) - 0.1).abs() < 1e-12);
        assert_eq!(hazard.signal_rate_hz(Time::from_ns(3)), 0.0);
    }
    assert_eq!(Hazard::new(&dark).cause(Time::ZERO, 0.0), Cause::Dark);
}

#[test]
fn without_any_rate_an_avalanche_never_comes() {
    let hazard = Hazard::new(&budget(0.0, 0.0, 3336, 137.0));
    assert_eq!(hazard.inverse(0.0), Time::ZERO);
    assert_eq!(hazard.inverse(1e-300), Time::NEVER);
    assert_eq!(hazard.at(Time::NEVER), 0.0);
    let signal = Hazard::new(&budget(0.0, 2.0, 3336, 137.0));
    assert_eq!(signal.inverse(2.0), Time::NEVER);
    assert!(signal.inverse(1.999_999) < Time::from_ns(5));
    assert_eq!(signal.at(Time::NEVER), 2.0);
    let faint = Hazard::new(&budget(0.0, 1e-320, 3336, 137.0));
    assert_eq!(faint.inverse(1e-16), Time::NEVER);
    let slow = Hazard::new(&budget(1e-9, 0.0, 3336, 137.0));
    assert_eq!(slow.inverse(30.0), Time::NEVER, "past the end of time");
}

#[test]
fn the_signal_rate_is_the_pulse() {
    let hazard = Hazard::new(&budget(1e9, 2.0, 3336, 137.0));
    let peak_hz = 2.0 / ((2.0 * std::f64::consts::PI).sqrt() * 137e-12);
    let at_peak_hz = hazard.signal_rate_hz(Time::from_fs(3_336_000));
    assert!((at_peak_hz / peak_hz - 1.0).abs() < 1e-4, "{at_peak_hz:e}");
    let at_sigma_hz = hazard.signal_rate_hz(Time::from_fs(3_336_000 - 137_000 + 1_070));
    assert!((at_sigma_hz / (peak_hz * (-0.5f64).exp()) - 1.0).abs() < 0.01);
    assert_eq!(hazard.signal_rate_hz(Time::from_ns(1)), 0.0);
    assert_eq!(hazard.signal_rate_hz(Time::NEVER), 0.0);
}

#[test]
fn causes_share_an_avalanche_by_their_rates() {
    let mut mixed = budget(1e9, 0.5, 3336, 137.0);
    mixed.dark_rate_hz = 1e9;
    let hazard = Hazard::new(&mixed);
    let peak = Time::from_fs(3_336_000);
    let signal = hazard.signal_rate_hz(peak) / (hazard.signal_rate_hz(peak) + 2e9);
    let dark = 1.0 - (1.0 - signal) / 2.0;
    for (uniform, cause) in [
        (0.0, Cause::Signal),
        (signal - 1e-9, Cause::Signal),
        (signal + 1e-9, Cause::Ambient),
        (dark - 1e-9, Cause::Ambient),
        (dark + 1e-9, Cause::Dark),
        (1.0, Cause::Dark),
    ] {
        assert_eq!(hazard.cause(peak, uniform), cause, "{uniform}");
    }
    assert_eq!(hazard.cause(Time::from_ns(1), 0.499), Cause::Ambient);
    assert_eq!(hazard.cause(Time::ZERO, 0.501), Cause::Dark);
}

#[test]
fn other_pulses_are_as_exact_as_their_length_allows() {
    let bump: Vec<_> = (0..80).map(|k| k as f64 * (-0.1 * k as f64).exp()).collect();
    let sampled = Pulse::Sampled(Samples::new(12.5, &bump).unwrap());
    for pulse in [Pulse::tailed(137.0, 137.0), Pulse::tailed(137.0, 20.0), sampled] {
        let budget = Budget { pulse, ..budget(0.27e9, 0.89, 3336, 137.0) };
        let hazard = Hazard::new(&budget);
        let (mean_ps, [from_ps, until_ps]) = (3336.0, budget.pulse.reach_ps());
        for k in 0..10_007 {
            let since_ps = from_ps + (until_ps - from_ps) * k as f64 / 10_007.0;
            let t = Time::from_ps_f64(mean_ps + since_ps);
            let exact = budget.background_rate_hz() * t.seconds()
                + budget.signal_per_shot * budget.pulse.part(since_ps);
            assert!((hazard.at(t) - exact).abs() < 5e-5, "{:?} at {since_ps}", budget.pulse);
            assert!(hazard.at(hazard.inverse(exact)) <= exact * (1.0 + 1e-12));
        }
    }
}
