//! Tests of the settings that affect the budget, and of those that do not.

use super::*;
use crate::scenario::AmbientModel;

fn budget(scenario: &Scenario) -> Budget {
    Budget::new(scenario, Pulse::default())
}

#[test]
fn the_default_pulse_has_184_pj_and_returns_after_3_3_ns() {
    let budget = budget(&Scenario::default());
    assert!((budget.pulse_energy_j - 184e-12).abs() < 1e-18);
    assert_eq!(budget.mean_arrival.fs(), 3_335_641);
    assert_eq!(budget.background_rate_hz() - budget.ambient_rate_hz, 100.0);
}

#[test]
fn the_laser_s_delay_moves_the_arrival_and_nothing_else() {
    let mut scenario = Scenario::default();
    let at_once = budget(&scenario);
    scenario.laser.delay_ps = 1234.5;
    let late = budget(&scenario);
    assert_eq!(late.mean_arrival.fs(), 3_335_641 + 1_234_500);
    assert_eq!((late.flight(), at_once.flight()), (at_once.mean_arrival, at_once.mean_arrival));
    let moved = Budget { mean_arrival: late.mean_arrival, delay: late.delay, ..at_once };
    assert_eq!(moved, late);
}

#[test]
fn a_black_target_returns_nothing() {
    let mut scenario = Scenario::default();
    scenario.target.reflectance = 0.0;
    for model in [AmbientModel::Fitted, AmbientModel::Physical] {
        scenario.ambient.model = model;
        let budget = budget(&scenario);
        assert_eq!((budget.signal_per_shot, budget.ambient_rate_hz), (0.0, 0.0));
    }
}

#[test]
fn light_outside_the_field_of_view_is_not_seen() {
    let mut scenario = Scenario::default();
    let whole = budget(&scenario).signal_per_shot;
    scenario.spad.field_of_view_deg = 10.5;
    let half = budget(&scenario).signal_per_shot / whole;
    let cos4 = |deg: f64| deg.to_radians().cos().powi(4);
    let expected = (1.0 - cos4(5.25)) / (1.0 - cos4(10.5));
    assert!((half / expected - 1.0).abs() < 2e-4, "{half} {expected}");
}

/// A named change of a scenario.
type Change = (&'static str, fn(&mut Scenario));

/// Computes the fitted rate as stated for the thesis's optics, factor by factor [1/s].
fn stated_hz(scenario: &Scenario) -> f64 {
    3.968e9 * scenario.ambient.irradiance_w_m2_nm * scenario.target.reflectance / 0.003
        * (scenario.spad.pdp * scenario.spad.fill_factor)
}

#[test]
fn the_thesis_optics_have_the_fitted_rate_to_the_bit_whatever_the_thesis_varies() {
    let changes: [Change; 7] = [
        ("as it is", |_| ()),
        ("reflectance", |s| s.target.reflectance = 0.08),
        ("irradiance", |s| s.ambient.irradiance_w_m2_nm = 0.4),
        ("pdp", |s| s.spad.pdp = 0.017),
        ("fill factor", |s| s.spad.fill_factor = 0.31),
        ("power", |s| s.laser.average_power_w = 1e-3),
        ("sub-elements", |s| s.target.cells = 37),
    ];
    for (name, change) in changes {
        for millimetres in [1, 50, 100, 250, 470, 500, 550, 600] {
            let mut scenario = Scenario::default();
            scenario.target.distance_m = millimetres as f64 / 1000.0;
            change(&mut scenario);
            let found = budget(&scenario).ambient_rate_hz;
            assert_eq!(found.to_bits(), stated_hz(&scenario).to_bits(), "{name}, {millimetres} mm");
        }
    }
}

#[test]
fn optics_move_the_fitted_rate_as_they_move_the_physical_one() {
    let changes: [Change; 10] = [
        ("lens.area_m2", |s| s.lens.area_m2 *= 10.0),
        ("lens.efficiency", |s| s.lens.efficiency = 0.4),
        ("filter.sigma_nm", |s| s.filter.sigma_nm = 1.0),
        ("filter.efficiency", |s| s.filter.efficiency = 0.9),
        ("spad.field_of_view_deg", |s| s.spad.field_of_view_deg = 5.0),
        ("spad.count", |s| s.spad.count = 1),
        ("spad.pdp", |s| s.spad.pdp = 0.02),
        ("laser.wavelength_nm", |s| s.laser.wavelength_nm = 850.0),
        ("target.length_m", |s| s.target.length_m = 0.01),
        ("no light comes through", |s| s.lens.area_m2 = 0.0),
    ];
    for (name, change) in changes {
        for distance_m in [0.1, 0.5, 0.6] {
            let rate = |model, change: fn(&mut Scenario)| {
                let mut scenario = Scenario::default();
                scenario.target.distance_m = distance_m;
                scenario.ambient.model = model;
                change(&mut scenario);
                budget(&scenario).ambient_rate_hz
            };
            let moved = |model| rate(model, change) / rate(model, |_| ());
            let (fitted, physical) = (moved(AmbientModel::Fitted), moved(AmbientModel::Physical));
            assert!((fitted - physical).abs() <= 1e-12 * physical, "{name}: {fitted} {physical}");
            assert!((physical - 1.0).abs() > 0.05, "{name} moves nothing");
        }
    }
}

#[test]
fn beyond_the_fit_the_rate_falls_with_the_targets_solid_angle() {
    let rate = |distance_m, side_m: Option<f64>| {
        let mut scenario = Scenario::default();
        scenario.target.distance_m = distance_m;
        if let Some(side_m) = side_m {
            (scenario.target.length_m, scenario.target.width_m) = (side_m, side_m);
        }
        budget(&scenario).ambient_rate_hz
    };
    let solid_angle = |distance_m: f64| 0.26 * 0.20 / (distance_m * distance_m);
    let expected = solid_angle(6.0) / solid_angle(3.0);
    assert!((rate(6.0, None) / rate(3.0, None) / expected - 1.0).abs() < 0.01);
    let step = rate(0.6, None) / rate(0.600_001, None);
    assert!((step - 1.0).abs() < 1e-4, "it does not jump where the fit ends: {step}");
    let wall = |distance_m| rate(distance_m, Some(10.0));
    for distance_m in [1.0, 2.0, 6.0] {
        assert!((wall(distance_m) / wall(0.6) - 1.0).abs() < 1e-3, "a wall at {distance_m} m");
    }
    assert!((1.12..1.13).contains(&(wall(0.6) / wall(0.1))), "{}", wall(0.6) / wall(0.1));
}
