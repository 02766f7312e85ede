//! Tests of the visible part of each shape against its own integral.

use std::f64::consts::PI;

use crate::scenario::{Shape, Target};

use super::*;

fn scene_of(change: impl FnOnce(&mut Scenario)) -> Scenario {
    let mut scenario = Scenario::default();
    (scenario.target.length_m, scenario.target.width_m) = (100.0, 100.0);
    change(&mut scenario);
    scenario
}

fn returned(change: impl FnOnce(&mut Scenario)) -> Returned {
    Scene::new(&scene_of(change), None).returned()
}

fn assert_close(found: f64, expected: f64, relative: f64) {
    let error = found / expected - 1.0;
    assert!(error.abs() < relative, "{found} for {expected}, error {error:e}");
}

/// Integrates from 0 to `end` by Simpson's rule.
fn integral(end: f64, of: impl Fn(f64) -> f64) -> f64 {
    let (steps, step) = (20_000, end / 20_000.0);
    let weight = |k: u32| match k {
        0 => 1.0,
        k if k == steps => 1.0,
        k if k % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=steps).map(|k| weight(k) * of(f64::from(k) * step)).sum::<f64>() * step / 3.0
}

/// Half angle of the laser's cone.
fn half() -> f64 {
    10.5f64.to_radians()
}

#[test]
fn a_plain_rectangle_is_seen_as_the_thesis_integral_has_it() {
    for (distance_m, length_m, width_m) in [(0.5, 100.0, 100.0), (0.6, 0.26, 0.2), (6.9, 0.3, 0.1)]
    {
        let scenario = scene_of(|s| {
            let size = Target { distance_m, length_m, width_m, ..Target::default() };
            s.target = Target { extended: true, ..size };
        });
        let expected = super::super::geometry::round_trip(&scenario.target, 21.0);
        let scene = Scene::new(&scenario, None);
        assert_close(scene.returned().diffuse.sum(), expected, 1e-4);
        let expected = super::super::geometry::projected_solid_angle(&scenario.target, 24.0);
        assert_close(scene.ambient().target_sr, expected, 1e-4);
        assert_eq!(scene.ambient().air_sr, 0.0);
    }
}

#[test]
fn a_disc_is_seen_as_its_rings_are() {
    for (d, radius_m) in [(0.5, 0.05), (0.5, 0.092), (5.0, 0.001)] {
        let found = returned(|s| {
            s.target.shape = Shape::Disc;
            (s.target.distance_m, s.target.radius_m) = (d, radius_m);
        });
        let inverse = |r2: f64| 1.0 / (r2 * r2);
        let expected = PI / 2.0 * d * d * (inverse(d * d) - inverse(d * d + radius_m * radius_m));
        assert_close(found.diffuse.sum(), expected, 1e-3);
        assert_close(found.diffuse.sum(), expected, 2e-5);
        // The mean way, ring by ring.
        let way = integral(radius_m, |x| 2.0 * PI * x * d * d / (d * d + x * x).powf(2.5));
        assert_close(found.diffuse.mean_m().unwrap(), way / expected, 1e-6);
    }
}

#[test]
fn a_turned_disc_off_the_axis_is_seen_as_a_sum_over_its_points() {
    let (radius_m, d, tilt_deg, yaw_deg) = (0.04, 0.5, 35.0f64, -20.0f64);
    let found = returned(|s| {
        s.target.shape = Shape::Disc;
        (s.target.distance_m, s.target.radius_m) = (d, radius_m);
        (s.target.tilt_deg, s.target.yaw_deg) = (tilt_deg, yaw_deg);
        (s.target.offset_x_m, s.target.offset_y_m) = (0.02, -0.03);
    });
    let ([sy, cy], [st, ct]) = (
        [yaw_deg.to_radians().sin(), yaw_deg.to_radians().cos()],
        [tilt_deg.to_radians().sin(), tilt_deg.to_radians().cos()],
    );
    let turned = |x: f64, y: f64, z: f64| {
        let (x, z) = (cy * x - sy * z, sy * x + cy * z);
        [x, ct * y - st * z, st * y + ct * z]
    };
    let normal = turned(0.0, 0.0, -1.0);
    let mut expected = 0.0;
    for ring in 0..400 {
        let radius = (f64::from(ring) + 0.5) / 400.0 * radius_m;
        for step in 0..400 {
            let angle = f64::from(step) * PI / 200.0;
            let [x, y, z] = turned(radius * angle.cos(), radius * angle.sin(), 0.0);
            let point = [x + 0.02, y - 0.03, z + d];
            let square: f64 = point.iter().map(|x| x * x).sum();
            let cos2 = point.iter().zip(normal).map(|(a, b)| a * b).sum::<f64>().powi(2) / square;
            expected += cos2 / (square * square) * radius * (radius_m / 400.0) * (PI / 200.0);
        }
    }
    assert_close(found.diffuse.sum(), expected, 1e-3);
    assert_close(found.diffuse.sum(), expected, 3e-5);
}

#[test]
fn a_sphere_is_seen_up_to_its_horizon() {
    for (d, radius_m) in [(0.5, 0.05), (0.3, 0.03), (4.0, 0.5)] {
        let found = returned(|s| {
            s.target.shape = Shape::Sphere;
            (s.target.distance_m, s.target.radius_m) = (d, radius_m);
        });
        // By the angle at its middle, which the horizon ends.
        let middle = d + radius_m;
        let expected = integral((radius_m / middle).acos(), |angle| {
            let r2 = middle * middle + radius_m * radius_m - 2.0 * middle * radius_m * angle.cos();
            let cos = (middle * angle.cos() - radius_m) / r2.sqrt();
            cos * cos / (r2 * r2) * 2.0 * PI * radius_m * radius_m * angle.sin()
        });
        assert_close(found.diffuse.sum(), expected, 1e-3);
        assert_close(found.diffuse.sum(), expected, 1e-4);
        assert!((d..d + radius_m).contains(&found.diffuse.mean_m().unwrap()));
        assert_close(found.surface_ends_m().unwrap()[0], d, 1e-4);
    }
}

#[test]
fn a_tilted_plane_that_fills_the_cone_has_a_closed_integral() {
    for (turn, tilt_deg) in [(0, 30.0f64), (0, -60.0), (1, 45.0)] {
        let found = returned(|s| match turn {
            0 => s.target.tilt_deg = tilt_deg,
            _ => s.target.yaw_deg = tilt_deg,
        });
        // cos^3 / p^2, of the plane's distance p, in the mean over the turn around the axis.
        let (sin, cos) = (tilt_deg.to_radians().sin(), tilt_deg.to_radians().cos());
        let edge = half().cos();
        let cubes = (1.0 - edge.powi(4)) / 4.0;
        let others = (1.0 - edge * edge) / 2.0 - cubes;
        let sum = cos.powi(3) * cubes + 1.5 * cos * sin * sin * others;
        let expected = 2.0 * PI * sum / (0.5 * cos * 0.5 * cos);
        assert_close(found.diffuse.sum(), expected, 1e-3);
        assert_close(found.diffuse.sum(), expected, 3e-5);
        let [near, far] = found.surface_ends_m().unwrap();
        let expected = |sign: f64| 0.5 * cos / (tilt_deg.to_radians() + sign * half()).cos();
        let (one, other) = (expected(1.0), expected(-1.0));
        assert_close(near, one.min(other), 1e-2);
        assert_close(far, one.max(other), 1e-2);
    }
}

#[test]
fn a_target_off_the_axis_is_the_half_that_the_cone_has_of_it() {
    let whole = returned(|s| s.target.extended = true);
    let half = returned(|s| (s.target.offset_x_m, s.target.length_m) = (50.0, 100.0));
    assert_close(half.diffuse.sum(), whole.diffuse.sum() / 2.0, 1e-4);
    let beside = returned(|s| s.target.offset_y_m = 50.1);
    assert_eq!((beside.diffuse.sum(), beside.surface_ends_m()), (0.0, None));
    assert_eq!(beside.diffuse.mean_m(), None);
}

#[test]
fn a_step_has_a_part_at_each_distance_and_the_near_one_hides_the_far_one() {
    let part = |distance_m: f64| {
        returned(|s| (s.target.distance_m, s.target.extended) = (distance_m, true)).diffuse.sum()
    };
    let step = |edge_m: f64| {
        returned(|s| {
            s.target.shape = Shape::Step;
            (s.target.second_distance_m, s.target.edge_m) = (0.8, edge_m);
        })
    };
    let even = step(0.0);
    assert_close(even.diffuse.sum(), (part(0.5) + part(0.8)) / 2.0, 1e-4);
    let near = |returned: &Returned| {
        let is_near = |part: &&[f64; 3]| part[0] < 0.6;
        returned.diffuse.parts().iter().filter(is_near).map(|part| part[2]).sum::<f64>()
    };
    assert_close(near(&even), part(0.5) / 2.0, 1e-4);
    // An edge to the right hides what is right behind it; the beam meets one or the other.
    let right = step(0.03);
    let angle_sr = |distance_m: f64, x_m: f64| {
        // Where a plane is cut off, by strips of the cone.
        let end = half().tan();
        integral(1.0, |part| {
            let u = x_m / distance_m + part * (end - x_m / distance_m);
            let v_end = (end * end - u * u).max(0.0).sqrt();
            let strip = integral_of_strip(u, v_end);
            strip * (end - x_m / distance_m) / (distance_m * distance_m)
        })
    };
    let expected = angle_sr(0.8, 0.03 * 0.8 / 0.5);
    assert_close(right.diffuse.sum() - near(&right), expected, 1e-3);
    assert_close(near(&right), part(0.5) - angle_sr(0.5, 0.03), 1e-4);
    // One to the left leaves a gap between both, where nothing is.
    let left = step(-0.03);
    assert_close(near(&left), angle_sr(0.5, 0.03), 1e-3);
    assert_close(left.diffuse.sum() - near(&left), part(0.8) - angle_sr(0.8, 0.03), 1e-3);
}

/// Integrates cos^2 / r^4 dA over a strip of a plane at one metre, which is 1 / (1 + u^2 + v^2)^3.
fn integral_of_strip(u: f64, v_end: f64) -> f64 {
    let steps = 200;
    let of = |k: u32| {
        let v = (f64::from(k) + 0.5) / f64::from(steps) * v_end;
        (1.0 + u * u + v * v).powi(-3)
    };
    2.0 * v_end / f64::from(steps) * (0..steps).map(of).sum::<f64>()
}

#[test]
fn a_patch_sends_back_by_its_own_area_and_the_target_around_it_diffuses() {
    let (side, d) = (0.02, 0.5);
    let of = |shape: Shape| {
        returned(|s| {
            s.target.shape = shape;
            (s.target.radius_m, s.target.retro_side_m, s.target.retro_x_m) = (0.05, side, 0.01);
        })
    };
    for shape in [Shape::Rectangle, Shape::Disc] {
        let found = of(shape);
        let whole = returned(|s| {
            (s.target.shape, s.target.extended, s.target.radius_m) = (shape, true, 0.05);
        });
        // A hundred by a hundred points.
        let (mut retro, mut diffuse) = (0.0, 0.0);
        for k in 0..10_000 {
            let place = |k: u32| (f64::from(k) + 0.5) / 100.0 * side - side / 2.0;
            let (x, y) = (place(k % 100) + 0.01, place(k / 100));
            let r2 = d * d + x * x + y * y;
            retro += side * side / 1e4 / (r2 * r2);
            diffuse += side * side / 1e4 * d * d / (r2 * r2 * r2);
        }
        assert_close(found.retro.sum(), retro, 1e-4);
        assert_close(whole.diffuse.sum() - found.diffuse.sum(), diffuse, 1e-3);
        assert_close(found.diffuse.sum(), whole.diffuse.sum() - diffuse, 1e-4);
    }
    // A patch beyond the edge of a rectangle is cut off there.
    let cut = returned(|s| {
        (s.target.length_m, s.target.retro_side_m, s.target.retro_x_m) = (0.1, 0.02, 0.05);
    });
    let half = returned(|s| {
        (s.target.retro_side_m, s.target.retro_x_m) = (0.02, 0.045);
        s.target.length_m = 0.1;
    });
    assert!(cut.retro.sum() < 0.7 * half.retro.sum());
}

#[test]
fn fog_takes_what_beer_and_lambert_say_on_both_ways() {
    let fog = |distance_m: f64| {
        returned(|s| {
            (s.target.distance_m, s.target.length_m, s.target.width_m) = (distance_m, 0.01, 0.01);
            s.atmosphere.visibility_m = 20.0;
        })
    };
    for distance_m in [0.5f64, 3.0, 7.0] {
        let expected = (-2.0 * 50f64.ln() / 20.0 * distance_m).exp();
        assert_close(fog(distance_m).transmission(), expected, 1e-3);
        assert_close(fog(distance_m).transmission(), expected, 2e-5);
    }
}

#[test]
fn ambient_light_passes_the_fog_once_and_the_fog_adds_its_own() {
    let ambient = |visibility_m: f64, away: f64| {
        let scenario = scene_of(|s| {
            (s.target.distance_m, s.target.offset_x_m) = (2.0, away);
            s.atmosphere.visibility_m = visibility_m;
        });
        Scene::new(&scenario, None).ambient()
    };
    let whole_sr = PI * 12f64.to_radians().sin().powi(2);
    let Ambient { target_sr, air_sr, .. } = ambient(1e6, 0.0);
    assert_close(target_sr, whole_sr, 1e-4);
    assert!(air_sr < 1e-4 * whole_sr, "{air_sr}");
    let fog = ambient(20.0, 0.0);
    let passes = (-(50f64.ln()) / 20.0 * 2.0).exp();
    assert!((0.99..1.0).contains(&(fog.target_sr / whole_sr / passes)), "ways are a bit longer");
    assert_close(fog.target_sr + fog.air_sr, whole_sr, 1e-4);
    let open = ambient(20.0, 1000.0);
    assert_eq!(open.target_sr, 0.0);
    assert_close(open.air_sr, whole_sr, 1e-12);
}

mod mesh;
mod second;
