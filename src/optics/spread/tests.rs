//! Tests of light over time against exact results.

use std::f64::consts::PI;

use super::*;
use crate::optics::air::Air;
use crate::optics::{Budget, Hazard};
use crate::scenario::{Scenario, Shape};

const C: f64 = 299_792_458.0;

fn assert_close(found: f64, expected: f64, relative: f64) {
    let error = found / expected - 1.0;
    assert!(error.abs() < relative, "{found} for {expected}, error {error:e}");
}

fn scenario(change: impl FnOnce(&mut Scenario)) -> Scenario {
    let mut scenario = Scenario::default();
    change(&mut scenario);
    scenario
}

fn budget(change: impl FnOnce(&mut Scenario)) -> Budget {
    let scenario = scenario(change);
    Budget::new(&scenario, Pulse::Gaussian { sigma_ps: scenario.laser.pulse_sigma_ps })
}

/// A budget of laser light only, with one returned photon.
fn alone(budget: &Budget) -> Budget {
    let all = budget.laser_per_shot();
    Budget {
        ambient_rate_hz: 0.0,
        airlight_rate_hz: 0.0,
        dark_rate_hz: 0.0,
        ..budget.dimmed(1.0 / all)
    }
}

fn times() -> impl Iterator<Item = Time> {
    (1..4000).map(|k| Time::from_ps_f64(f64::from(k) * 2.5))
}

#[test]
fn one_distance_comes_as_the_pulse_does() {
    let mut returned = Returned::default();
    returned.diffuse.add(0.500_123, 0.0, 2.0, 2.0);
    // So that the other one lies between two places of the grid.
    returned.retro.add(0.3, 0.0, 1.0, 1.0);
    for pulse in [Pulse::default(), Pulse::tailed(137.0, 150.0), Pulse::Gaussian { sigma_ps: 12.5 }]
    {
        let delay = Time::from_ps_f64(700.0);
        let (spread, air) = Spread::new(&returned, None, &pulse, delay, 7.0, FINE);
        assert_eq!(air, 0.0);
        let mean_arrival = delay + Time::from_ps_f64(0.500_123 * 2e12 / C);
        let echo_pulse = pulse.clone();
        let echo = Budget { signal_per_shot: 1.0, mean_arrival, pulse, ..Budget::default() };
        let over_time = Budget { spread: Some(Arc::new(spread)), ..echo.clone() };
        let [echo, over_time] = [echo, over_time].map(|budget| Hazard::new(&budget));
        let worst = times().map(|t| (echo.at(t) - over_time.at(t)).abs()).fold(0.0, f64::max);
        let most = if matches!(echo_pulse, Pulse::Gaussian { .. }) { 3e-5 } else { 1e-4 };
        assert!(worst < most, "{echo_pulse:?}: {worst:e}");
    }
}

#[test]
fn a_slope_of_distances_comes_as_the_integral_over_the_pulse_does() {
    let mut returned = Returned::default();
    // Even from 0.4 to 0.6 m, in a few long parts.
    for k in 0..10 {
        let at_m = 0.41 + 0.02 * f64::from(k);
        returned.diffuse.add(at_m, 0.02 / 12f64.sqrt(), 1.0, 1.0);
    }
    let pulse = Pulse::default();
    let (spread, _) = Spread::new(&returned, None, &pulse, Time::ZERO, 7.0, FINE);
    assert_eq!(spread.ends.map(|end| end.ps()), [2668, 4002]);
    let over_time =
        Budget { signal_per_shot: 1.0, spread: Some(Arc::new(spread)), ..Budget::default() };
    let hazard = Hazard::new(&over_time);
    for t in times().step_by(7) {
        let part = |k: u32| {
            let at_ps = (0.4 + (f64::from(k) + 0.5) * 1e-4) * 2e12 / C;
            pulse.part(t.fs() as f64 * 1e-3 - at_ps)
        };
        let expected = (0..2000).map(part).sum::<f64>() / 2000.0;
        assert!((hazard.at(t) - expected).abs() < 3e-5, "{t:?}: {} {expected}", hazard.at(t));
    }
}

/// Evaluates the lidar equation over a cone whose lines of sight end on a plane perpendicular to the axis, or
/// nowhere.
fn closed_backscatter(air: &Air, plane_m: Option<f64>, end_m: f64) -> f64 {
    let half = 10.5f64.to_radians();
    let along = |until_m: f64| {
        // In the logarithm of the distance, by Simpson's rule.
        let (steps, from) = (2000, air.from_m.ln());
        let step = (until_m.ln() - from) / f64::from(steps);
        let of = |k: u32| {
            let r = (from + f64::from(k) * step).exp();
            (-2.0 * air.extinction_per_m * r).exp() / r
        };
        let inner = (1..steps).map(|k| f64::from(2 + 2 * (k % 2)) * of(k)).sum::<f64>();
        air.backscatter_per_m_sr * (of(0) + inner + of(steps)) * step / 3.0
    };
    let Some(plane_m) = plane_m else { return 2.0 * PI * (1.0 - half.cos()) * along(end_m) };
    let rings = 200;
    let ring = |k: u32| {
        let angle = (f64::from(k) + 0.5) / f64::from(rings) * half;
        2.0 * PI * angle.sin() * half / f64::from(rings) * along(plane_m / angle.cos())
    };
    (0..rings).map(ring).sum()
}

#[test]
fn what_the_air_sends_back_is_the_closed_integral() {
    for (visibility_m, rain_mm_h, overlap_m) in
        [(20.0, 0.0, 0.1), (5.0, 0.0, 0.3), (0.0, 100.0, 0.05)]
    {
        for plane in [Some(0.5), Some(2.0), None] {
            let scenario = scenario(|s| {
                s.atmosphere.visibility_m = visibility_m;
                (s.atmosphere.rain_mm_h, s.atmosphere.overlap_m) = (rain_mm_h, overlap_m);
                (s.target.length_m, s.target.width_m) = (100.0, 100.0);
                match plane {
                    Some(distance_m) => s.target.distance_m = distance_m,
                    None => s.target.offset_x_m = 200.0,
                }
            });
            let air = Air::of(&scenario);
            let scene = super::super::scene::Scene::new(&scenario, None);
            let horizon_m = 7.0;
            let (_, found) = Spread::new(
                &scene.returned(),
                None,
                &Pulse::default(),
                Time::ZERO,
                horizon_m,
                FINE,
            );
            let expected = closed_backscatter(&air, plane, horizon_m);
            assert_close(found, expected, 1e-3);
            assert_close(found, expected, 2e-4);
        }
    }
}

#[test]
fn backscatter_comes_before_the_echo_as_the_lidar_equation_has_it_over_time() {
    let budget = budget(|s| {
        s.atmosphere.visibility_m = 10.0;
        (s.target.distance_m, s.target.length_m, s.target.width_m) = (0.8, 10.0, 10.0);
        s.laser.pulse_sigma_ps = 5.0;
    });
    let hazard = Hazard::new(&alone(&budget));
    let part = budget.backscatter_per_shot / budget.laser_per_shot();
    assert!((0.05..0.95).contains(&part), "{part}");
    let until = |m: f64| hazard.at(Time::from_ps_f64(m * 2e12 / C));
    let closed = |m: f64| {
        let scenario = scenario(|s| s.atmosphere.visibility_m = 10.0);
        closed_backscatter(&Air::of(&scenario), None, m)
    };
    assert!(until(0.09) < 1e-6, "before the overlap");
    let whole = until(0.75) / closed(0.75);
    for m in [0.12, 0.2, 0.4, 0.6] {
        assert_close(until(m) / closed(m), whole, 1e-3);
    }
    assert_close(until(0.75), part, 0.1);
}

#[test]
fn a_step_of_the_grid_is_bounded_however_long_the_light_comes() {
    let mut returned = Returned::default();
    returned.diffuse.add(0.5, 0.0, 1.0, 1.0);
    returned.diffuse.add(6.0, 0.0, 1.0, 1.0);
    returned.diffuse.add(900.0, 0.0, 1.0, 1.0);
    let (spread, _) =
        Spread::new(&returned, None, &Pulse::Gaussian { sigma_ps: 1.0 }, Time::ZERO, 30.0, FINE);
    let nodes = spread.of([1.0, 0.0, 0.0, 0.0, 0.0]);
    assert!(nodes.len() <= 65_010, "{}", nodes.len());
    assert!(nodes.windows(2).all(|pair| pair[0] <= pair[1]));
    assert_eq!((nodes[0], nodes[nodes.len() - 1]), (0.0, 1.0));
    let at = |m: f64| nodes[((m * 2e15 / C - spread.from) / spread.step) as usize];
    // What would come after the next pulse comes last, where no shot has got to.
    assert!((at(3.0) - 1.0 / 3.0).abs() < 1e-9 && (at(29.9) - 2.0 / 3.0).abs() < 1e-9);
}

#[test]
fn a_budget_is_as_continuous_as_the_scene() {
    let plain = budget(|_| ());
    let extended = budget(|s| s.target.extended = true);
    assert!((extended.signal_per_shot / plain.signal_per_shot - 1.0).abs() < 1e-4);
    assert!((extended.ambient_rate_hz / plain.ambient_rate_hz - 1.0).abs() < 1e-4);
    assert!(extended.mean_arrival > plain.mean_arrival, "ways beside the axis are longer");
    let hardly = budget(|s| s.atmosphere.visibility_m = 1e6);
    assert!((hardly.signal_per_shot / plain.signal_per_shot - 1.0).abs() < 1e-4);
    assert_eq!(hardly.mean_arrival, plain.mean_arrival);
    let ball = budget(|s| s.target.shape = Shape::Sphere);
    assert!(ball.signal_per_shot < plain.signal_per_shot && ball.spread.is_some());
    assert_eq!(ball.backscatter_per_shot, 0.0);
}

#[test]
fn light_ends_where_surfaces_have_ended_all_of_the_beam() {
    let air = Air::of(&scenario(|s| s.atmosphere.visibility_m = 5.0));
    let until = |horizon_m: f64, ended_sr: f64| {
        let mut returned = Returned::default();
        returned.diffuse.add(0.8, 0.0, 1.0, 1.0);
        returned.air = Some(Haze::new(air, 1.0, vec![[0.8, ended_sr], [0.5, 0.3]]));
        let (spread, air) =
            Spread::new(&returned, None, &Pulse::default(), Time::ZERO, horizon_m, COARSE);
        (spread.parts.iter().map(|part| part.len()).max(), spread, air)
    };
    let [near, far] = [2.0, 7.0].map(|horizon_m| until(horizon_m, 0.7));
    assert_eq!(near, far);
    let [near, far] = [2.0, 7.0].map(|horizon_m| until(horizon_m, 0.6));
    assert!(near.0 < far.0 && near.2 < far.2, "a part of the beam goes on");
}
