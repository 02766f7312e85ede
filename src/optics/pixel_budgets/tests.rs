//! Tests of pixels against their whole field of view, and against integrals over the directions of each.

use std::f64::consts::PI;

use super::*;
use crate::optics::budget::{LIGHT_M_S, PixelPath};
use crate::scenario::mesh::Point;
use crate::scenario::mesh::tests::{cube, of};
use crate::scenario::{AmbientModel, Array, Shape};

/// Distance of targets [m].
const DISTANCE_M: f64 = 0.5;
/// Radius of a sphere [m].
const RADIUS_M: f64 = 0.06;
/// Tilt or yaw of a plane [deg].
const TURN_DEG: f64 = 30.0;
/// A field of view with corners outside of the laser's cone [deg].
const WIDE_DEG: [f64; 2] = [24.0, 18.0];

type Change = fn(&mut Scenario);
type Amount = fn(&Budget) -> f64;

fn scenario([rows, columns]: [u32; 2], field_of_view_deg: [f64; 2], change: Change) -> Scenario {
    let mut scenario = Scenario::default();
    let field_of_view_deg = Some(field_of_view_deg);
    scenario.array = Array { rows, columns, field_of_view_deg, ..Array::default() };
    (scenario.target.length_m, scenario.target.width_m) = (10.0, 10.0);
    scenario.target.distance_m = DISTANCE_M;
    change(&mut scenario);
    scenario
}

fn with_mesh(scenario: &Scenario, mesh: &Mesh) -> Vec<Budget> {
    let pixels = Pixels::of(scenario).unwrap();
    let count = pixels.rows * pixels.columns;
    let mesh = (scenario.target.shape == Shape::Mesh).then_some(mesh);
    let budgets = PixelBudgets::new(scenario, pixels, mesh);
    (0..count)
        .map(|place| budgets.of(scenario, Pulse::default(), place, &PixelPath::default()))
        .collect()
}

/// Returns the budgets of all pixels; the mesh is a cube.
fn budgets(scenario: &Scenario) -> Vec<Budget> {
    with_mesh(scenario, &cube())
}

fn mean_m(budget: &Budget) -> f64 {
    budget.flight().seconds() * LIGHT_M_S / 2.0
}

#[test]
fn pixels_share_the_light_of_their_field_of_view() {
    let scenes: [(&str, Change); 14] = [
        ("plane", |_| ()),
        ("rectangle", |s| (s.target.length_m, s.target.width_m) = (0.13, 0.07)),
        ("tilt", |s| s.target.tilt_deg = TURN_DEG),
        ("yaw", |s| s.target.yaw_deg = -TURN_DEG),
        ("step", |s| (s.target.shape, s.target.edge_m) = (Shape::Step, 0.01)),
        ("disc", |s| (s.target.shape, s.target.radius_m) = (Shape::Disc, RADIUS_M)),
        ("sphere", |s| (s.target.shape, s.target.radius_m) = (Shape::Sphere, RADIUS_M)),
        ("patch", |s| (s.target.retro_side_m, s.target.retro_x_m) = (0.03, 0.02)),
        ("mesh", |s| {
            (s.target.shape, s.target.mesh_unit_m) = (Shape::Mesh, 0.04);
            (s.target.yaw_deg, s.target.tilt_deg) = (30.0, 20.0);
        }),
        ("fog", |s| s.atmosphere.visibility_m = 5.0),
        ("glass", |s| {
            (s.cover.fraction, s.cover.dirt_per_h, s.cover.age_h) = (3e-4, 1e-5, 2.0);
        }),
        ("second surface", |s| {
            (s.target.second_share, s.target.second_distance_m) = (0.3, 0.35);
            (s.target.shape, s.target.radius_m) = (Shape::Disc, RADIUS_M);
        }),
        ("fog alone", |s| (s.atmosphere.visibility_m, s.target.offset_x_m) = (5.0, 100.0)),
        ("rain", |s| (s.target.shape, s.atmosphere.rain_mm_h) = (Shape::Step, 100.0)),
    ];
    let amounts: [(&str, Amount); 9] = [
        ("signal", |budget| budget.signal_per_shot),
        ("patch", |budget| budget.retro_per_shot),
        ("backscatter", |budget| budget.backscatter_per_shot),
        ("glass", |budget| budget.cover_per_shot),
        ("second surface", |budget| budget.second_per_shot),
        ("its ambient light", |budget| budget.second_rate_hz),
        ("ambient light", |budget| budget.ambient_rate_hz),
        ("airlight", |budget| budget.airlight_rate_hz),
        ("distance", |budget| budget.signal_per_shot * mean_m(budget)),
    ];
    for (scene, change) in scenes {
        let of = |size| budgets(&scenario(size, WIDE_DEG, change));
        let (parts, whole) = (of([6, 8]), of([1, 1]));
        for (name, amount) in amounts {
            let (sum, whole) = (parts.iter().map(amount).sum::<f64>(), amount(&whole[0]));
            let error = (sum - whole).abs();
            assert!(error <= 2e-4 * whole, "{scene}, {name}: {sum} of {whole}");
        }
    }
}

/// Distance along a line of sight, and the cosine of its angle to the surface's normal [m, 1].
type Hit = [f64; 2];
type Sight<'a> = &'a dyn Fn(f64, f64) -> Option<Hit>;

fn length(u: f64, v: f64) -> f64 {
    (1.0 + u * u + v * v).sqrt()
}

/// A plane with z = d + a x + b y.
fn plane(a: f64, b: f64) -> impl Fn(f64, f64) -> Option<Hit> {
    move |u, v| {
        let slope = 1.0 - a * u - b * v;
        Some([
            DISTANCE_M / slope * length(u, v),
            slope / length(u, v) / (1.0 + a * a + b * b).sqrt(),
        ])
    }
}

/// A sphere whose nearest point is on the axis, by the law of cosines.
fn sphere(u: f64, v: f64) -> Option<Hit> {
    let middle = DISTANCE_M + RADIUS_M;
    let along = middle / length(u, v);
    let half2 = RADIUS_M * RADIUS_M - middle * middle + along * along;
    (half2 > 0.0).then(|| [along - half2.sqrt(), half2.sqrt() / RADIUS_M])
}

/// Returns the directions of a pixel without distortion, in the plane one metre in front of the sensor: from the left
/// to the right end, and from the lower to the upper one [m].
fn directions(scenario: &Scenario, [width, height]: [f64; 2], place: usize) -> [[f64; 2]; 2] {
    let Array { rows, columns, .. } = scenario.array;
    let (row, column) = (place / columns as usize, place % columns as usize);
    [
        [column, column + 1].map(|edge| width * (2.0 * edge as f64 / f64::from(columns) - 1.0)),
        [row + 1, row].map(|edge| height * (1.0 - 2.0 * edge as f64 / f64::from(rows))),
    ]
}

/// Integrates over directions, of which the laser lights those in its cone: cos / r^2, r cos / r^2, and the cosine to
/// the axis of all [1/m^2, 1/m, sr].
fn integrals([us, vs]: [[f64; 2]; 2], hit: Sight, steps: u32) -> [f64; 3] {
    let reach = 10.5f64.to_radians().tan();
    let size = |[from, to]: [f64; 2]| (to - from) / f64::from(steps);
    let middle = |ends: [f64; 2], step: u32| ends[0] + (f64::from(step) + 0.5) * size(ends);
    let mut sums = [0.0; 3];
    for step in 0..steps * steps {
        let (u, v) = (middle(us, step % steps), middle(vs, step / steps));
        let Some([r, cos]) = hit(u, v) else { continue };
        let sr = size(us) * size(vs) / length(u, v).powi(3);
        if u.hypot(v) < reach {
            sums[0] += cos / (r * r) * sr;
            sums[1] += cos / r * sr;
        }
        sums[2] += sr / length(u, v);
    }
    sums
}

/// Returns the avalanches of a shot for a sum of 1/m^2, and the rate of those from ambient light for 1 sr, both by a
/// target's radiance, the lens's area and the energy of photons [m^2, 1/(s sr)].
fn avalanches(scenario: &Scenario) -> [f64; 2] {
    let Scenario { laser, lens, filter, spad, ambient, .. } = scenario;
    let photon_j = 6.626_070_15e-34 * LIGHT_M_S / (laser.wavelength_nm * 1e-9);
    let detected = lens.efficiency * filter.efficiency * spad.pdp * spad.fill_factor / photon_j;
    let of_exitance = scenario.target.reflectance / PI * lens.area_m2 * detected;
    let cone_sr = 2.0 * PI * (1.0 - (laser.field_of_illumination_deg / 2.0).to_radians().cos());
    let beam_j_sr = laser.average_power_w / laser.repetition_rate_hz / cone_sr;
    let passband_nm = (2.0 * PI).sqrt() * filter.sigma_nm;
    [beam_j_sr * of_exitance, ambient.irradiance_w_m2_nm * passband_nm * of_exitance]
}

fn assert_close(found: f64, expected: f64, relative: f64) {
    assert!((found - expected).abs() <= relative * expected, "{found} for {expected}");
}

#[test]
fn each_pixel_has_the_integral_over_its_directions() {
    let slope = TURN_DEG.to_radians().tan();
    let scenes: [(Change, Sight); 5] = [
        (|_| (), &plane(0.0, 0.0)),
        (|s| s.target.tilt_deg = TURN_DEG, &plane(0.0, slope)),
        (|s| s.target.yaw_deg = TURN_DEG, &plane(slope, 0.0)),
        (|s| (s.target.shape, s.target.radius_m) = (Shape::Sphere, RADIUS_M), &sphere),
        (|s| s.target.shape = Shape::Mesh, &plane(0.0, 0.0)),
    ];
    for (change, hit) in scenes {
        let mut scenario = scenario([4, 5], WIDE_DEG, change);
        scenario.ambient.model = AmbientModel::Physical;
        let ends = WIDE_DEG.map(|full_deg| (full_deg / 2.0).to_radians().tan());
        let [per_m2, hz_per_sr] = avalanches(&scenario);
        for (place, budget) in budgets(&scenario).iter().enumerate() {
            let [light, way, seen_sr] = integrals(directions(&scenario, ends, place), hit, 400);
            // Of cone and sphere a part of a pixel is seen too; the others are within 4e-5 and 1 um.
            assert_close(budget.signal_per_shot, per_m2 * light, 1e-3);
            assert_close(budget.ambient_rate_hz, hz_per_sr * seen_sr, 1e-3);
            if light > 0.0 {
                assert!((mean_m(budget) - way / light).abs() < 1e-4, "{}", mean_m(budget));
            }
        }
    }
}

#[test]
fn square_pixels_fill_the_rectangle_of_the_cone_unless_a_field_of_view_is_given() {
    let mut scenario = scenario([40, 30], WIDE_DEG, |_| ());
    scenario.array.field_of_view_deg = None;
    // A diagonal of 50 pixels.
    let ends = [30.0, 40.0].map(|count| 10.5f64.to_radians().tan() * count / 50.0);
    let [per_m2, _] = avalanches(&scenario);
    for (place, budget) in budgets(&scenario).iter().enumerate() {
        let directions = directions(&scenario, ends, place);
        let [light, way, _] = integrals(directions, &plane(0.0, 0.0), 10);
        assert_close(budget.signal_per_shot, per_m2 * light, 1e-5);
        assert!((mean_m(budget) - way / light).abs() < 1e-6);
    }
}

#[test]
fn row_0_is_the_top_and_column_0_the_left() {
    let shapes: [Change; 4] = [
        |s| s.target.shape = Shape::Rectangle,
        |s| s.target.shape = Shape::Disc,
        |s| s.target.shape = Shape::Sphere,
        |s| s.target.shape = Shape::Mesh,
    ];
    for shape in shapes {
        for (x_m, y_m, lit) in
            [(-0.03, 0.02, 0), (0.03, 0.02, 1), (-0.03, -0.02, 2), (0.03, -0.02, 3)]
        {
            let mut scenario = scenario([2, 2], [16.0, 12.0], shape);
            let target = &mut scenario.target;
            (target.length_m, target.width_m) = (0.01, 0.01);
            (target.radius_m, target.mesh_unit_m) = (0.005, 0.005);
            (target.offset_x_m, target.offset_y_m) = (x_m, y_m);
            for (place, budget) in budgets(&scenario).iter().enumerate() {
                let is_seen = [budget.signal_per_shot, budget.ambient_rate_hz].map(|x| x > 0.0);
                assert_eq!(is_seen, [place == lit; 2], "{:?} {place}", scenario.target.shape);
            }
        }
    }
    let distances_m = |change| {
        let budgets = budgets(&scenario([2, 2], [16.0, 12.0], change));
        [0, 1, 2, 3].map(|place| mean_m(&budgets[place]))
    };
    let to_the_right: [Change; 2] =
        [|s| s.target.shape = Shape::Step, |s| s.target.yaw_deg = TURN_DEG];
    for change in to_the_right {
        let [a, b, c, d] = distances_m(change);
        assert!(a.max(c) < b.min(d), "{a} {b} {c} {d}");
    }
    let [a, b, c, d] = distances_m(|s| s.target.tilt_deg = TURN_DEG);
    assert!(c.max(d) < a.min(b), "{a} {b} {c} {d}");
}

#[test]
fn of_a_mesh_beside_the_field_of_view_nothing_is_seen() {
    let aside = scenario([3, 4], WIDE_DEG, |s| {
        (s.target.shape, s.target.offset_x_m) = (Shape::Mesh, 100.0);
    });
    for budget in budgets(&aside) {
        assert_eq!((budget.signal_per_shot, budget.ambient_rate_hz), (0.0, 0.0));
        assert!((mean_m(&budget) - DISTANCE_M).abs() < 1e-6, "{}", mean_m(&budget));
    }
}

#[test]
fn a_mesh_is_in_front_of_the_sensor_wherever_the_origin_of_its_file_is() {
    let moved = |z: f64| {
        let corner = |[x, y, w]: Point| [x, y, w + z];
        of(cube().triangles().iter().map(|triangle| triangle.map(corner)).collect())
    };
    let near = scenario([3, 4], WIDE_DEG, |s| {
        (s.target.shape, s.target.mesh_unit_m) = (Shape::Mesh, 0.04);
    });
    let usual = with_mesh(&near, &cube());
    assert!(usual.iter().any(|budget| budget.signal_per_shot > 0.0));
    for z in [-64.0, 64.0] {
        for (found, usual) in with_mesh(&near, &moved(z)).iter().zip(&usual) {
            assert_close(found.signal_per_shot, usual.signal_per_shot, 1e-9);
            assert!((mean_m(found) - mean_m(usual)).abs() < 1e-9);
        }
    }
}
