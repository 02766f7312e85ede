//! Tests of a second surface against the target and itself alone.

use super::*;
use crate::kernel::Time;
use crate::kernel::pulse::{Pulse, normal_cdf};
use crate::optics::{Budget, Hazard};

/// Distances and reflectances of target and second surface [m, 1].
const BOTH: [[f64; 2]; 2] = [[0.7, 0.6], [0.35, 0.2]];

fn scenario(share: f64, change: impl FnOnce(&mut Scenario)) -> Scenario {
    let mut scenario = Scenario::default();
    let [[distance_m, reflectance], [second_m, second_reflectance]] = BOTH;
    (scenario.target.distance_m, scenario.target.reflectance) = (distance_m, reflectance);
    scenario.target.second_distance_m = second_m;
    (scenario.target.second_share, scenario.target.second_reflectance) =
        (share, second_reflectance);
    change(&mut scenario);
    scenario
}

/// The same with one surface only, as the target.
fn alone([distance_m, reflectance]: [f64; 2], change: impl FnOnce(&mut Scenario)) -> Scenario {
    scenario(0.0, |s| {
        (s.target.distance_m, s.target.reflectance) = (distance_m, reflectance);
        change(s);
    })
}

fn budget(scenario: &Scenario) -> Budget {
    Budget::new(scenario, Pulse::default())
}

type Change = fn(&mut Scenario);

/// Light along the axis, a sum over elements, a pixel of an array's, and fog.
const WAYS: [Change; 4] = [
    |_| (),
    |s| s.target.extended = true,
    |s| s.array.field_of_view_deg = Some([12.0, 9.0]),
    |s| s.atmosphere.visibility_m = 30.0,
];

#[test]
fn a_surface_with_all_or_no_lines_of_sight_is_there_alone_or_not_at_all() {
    for change in WAYS {
        let none = scenario(0.0, |s| {
            change(s);
            (s.target.second_reflectance, s.target.second_distance_m) = (0.9, 0.2);
        });
        assert_eq!(budget(&none), budget(&alone(BOTH[0], change)));
        let (all, only) = (budget(&scenario(1.0, change)), budget(&alone(BOTH[1], change)));
        assert_eq!((all.signal_per_shot, all.ambient_rate_hz), (0.0, 0.0));
        assert_close(all.second_per_shot, only.signal_per_shot, 1e-12);
        assert_close(all.second_rate_hz, only.ambient_rate_hz, 1e-12);
        assert_eq!((all.mean_arrival, all.target_ends()), (only.mean_arrival, only.target_ends()));
    }
    // Of plain rectangles it is the same to the bit.
    let pair = [scenario(1.0, |_| ()), alone(BOTH[1], |_| ())].map(|scenario| budget(&scenario));
    assert_eq!(pair[0].second_per_shot, pair[1].signal_per_shot);
    assert_eq!(pair[0].second_rate_hz, pair[1].ambient_rate_hz);
    let [all, only] = pair.map(|budget| Hazard::new(&budget));
    for ps in (0..8000).step_by(37) {
        let t = Time::from_ps_f64(f64::from(ps));
        assert_eq!(all.at(t), only.at(t), "{t}");
    }
}

#[test]
fn two_surfaces_share_their_light_as_they_share_the_lines_of_sight() {
    for change in WAYS {
        let budgets = [scenario(0.3, change), alone(BOTH[0], change), alone(BOTH[1], change)];
        let [both, first, second] = budgets.map(|scenario| budget(&scenario));
        assert_close(both.signal_per_shot, 0.7 * first.signal_per_shot, 1e-12);
        assert_close(both.ambient_rate_hz, 0.7 * first.ambient_rate_hz, 1e-12);
        assert_close(both.second_per_shot, 0.3 * second.signal_per_shot, 1e-12);
        assert_close(both.second_rate_hz, 0.3 * second.ambient_rate_hz, 1e-12);
        let backscatter = 0.7 * first.backscatter_per_shot + 0.3 * second.backscatter_per_shot;
        assert!((both.backscatter_per_shot - backscatter).abs() <= 1e-3 * backscatter);
        assert_eq!(both.mean_arrival, first.mean_arrival, "the target is where it was");
        assert_eq!(both.target_ends(), first.target_ends());
    }
}

#[test]
fn sums_over_elements_have_the_light_of_the_closed_form() {
    let narrow = |s: &mut Scenario| s.laser.field_of_illumination_deg = 3.0;
    let plain = budget(&scenario(0.3, narrow));
    let summed = budget(&scenario(0.3, |s| {
        narrow(s);
        s.target.extended = true;
    }));
    assert_close(summed.signal_per_shot, plain.signal_per_shot, 1e-4);
    assert_close(summed.second_per_shot, plain.second_per_shot, 1e-4);
    assert_close(summed.second_rate_hz, plain.second_rate_hz, 1e-4);
    let [plain, summed] = [plain, summed].map(|budget| Hazard::new(&budget));
    for ps in (1..8000).step_by(37) {
        let t = Time::from_ps_f64(f64::from(ps));
        assert!((plain.at(t) - summed.at(t)).abs() < 2e-3, "{t}");
    }
}

#[test]
fn the_hazard_is_that_of_two_echoes_added_up() {
    let both = budget(&scenario(0.3, |_| ()));
    let hazard = Hazard::new(&both);
    for ps in (1..9000).step_by(13).map(f64::from) {
        let echo = |distance_m: f64| normal_cdf((ps - 2e12 * distance_m / 299_792_458.0) / 137.0);
        let expected = both.background_rate_hz() * ps * 1e-12
            + both.signal_per_shot * echo(0.7)
            + both.second_per_shot * echo(0.35);
        let found = hazard.at(Time::from_ps_f64(ps));
        assert!((found - expected).abs() < 1e-4 * both.laser_per_shot(), "{found} for {expected}");
    }
}
