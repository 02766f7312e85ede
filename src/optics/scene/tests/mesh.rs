//! Tests of meshes against the integrals of the shapes that they approximate.

use crate::scenario::mesh::tests::{cube, of};
use crate::scenario::mesh::{Mesh, Point};

use super::*;

/// A sphere of radius 1 in rings and sectors, with its poles on the axis.
fn ball(rings: u32, sectors: u32) -> Mesh {
    let point = |ring: u32, sector: u32| -> Point {
        let polar = PI * f64::from(ring) / f64::from(rings);
        let around = 2.0 * PI * f64::from(sector % sectors) / f64::from(sectors);
        // Poles are one point each.
        let sin = if ring == 0 || ring == rings { 0.0 } else { polar.sin() };
        [sin * around.cos(), sin * around.sin(), polar.cos()]
    };
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for sector in 0..sectors {
            let (a, b) = (point(ring, sector), point(ring + 1, sector));
            let (c, d) = (point(ring + 1, sector + 1), point(ring, sector + 1));
            if ring + 1 < rings {
                triangles.push([a, b, c]);
            }
            if ring > 0 {
                triangles.push([a, c, d]);
            }
        }
    }
    of(triangles)
}

fn seen(mesh: &Mesh, change: impl FnOnce(&mut Scenario)) -> Returned {
    let scenario = scene_of(|s| {
        s.target.shape = Shape::Mesh;
        change(s);
    });
    Scene::new(&scenario, Some(mesh)).returned()
}

#[test]
fn a_ball_of_triangles_is_seen_as_a_sphere() {
    let mesh = ball(200, 400);
    for (distance_m, radius_m) in [(0.5, 0.05), (0.3, 0.03)] {
        let found = seen(&mesh, |s| {
            (s.target.distance_m, s.target.mesh_unit_m) = (distance_m, radius_m);
        });
        let expected = returned(|s| {
            s.target.shape = Shape::Sphere;
            (s.target.distance_m, s.target.radius_m) = (distance_m, radius_m);
        });
        assert_close(found.diffuse.sum(), expected.diffuse.sum(), 1e-3);
        let [found, expected] = [&found, &expected].map(|one| one.diffuse.mean_m().unwrap());
        assert_close(found, expected, 1e-4);
    }
}

#[test]
fn a_cube_is_seen_as_its_faces_are_whichever_way_it_is_turned() {
    let mesh = cube();
    let plane = |side_m: f64, distance_m: f64| {
        let face = |s: &mut Scenario| {
            (s.target.distance_m, s.target.extended) = (distance_m, true);
            (s.target.length_m, s.target.width_m) = (side_m, side_m);
        };
        returned(face).diffuse.sum()
    };
    let unit = |s: &mut Scenario| (s.target.distance_m, s.target.mesh_unit_m) = (0.5, 0.04);
    assert_close(seen(&mesh, unit).diffuse.sum(), plane(0.08, 0.5), 1e-4);
    // From a corner of 45 degrees both faces are seen, and those behind are not.
    let turned = seen(&mesh, |s| {
        unit(s);
        s.target.yaw_deg = 45.0;
    });
    let half = |yaw_deg: f64, offset_x_m: f64| {
        returned(|s| {
            (s.target.distance_m, s.target.yaw_deg) = (0.5 + 0.02 * 2f64.sqrt() * 1.0, yaw_deg);
            (s.target.length_m, s.target.width_m) = (0.08, 0.08);
            s.target.offset_x_m = offset_x_m;
        })
    };
    let aside = 0.04 / 2f64.sqrt();
    let expected = half(45.0, aside).diffuse.sum() + half(-45.0, -aside).diffuse.sum();
    assert_close(turned.diffuse.sum(), expected, 1e-3);
    assert_close(turned.surface_ends_m().unwrap()[0], 0.5, 1e-3);
}

#[test]
fn a_mesh_that_fills_the_cone_has_the_closed_form() {
    let found = seen(&cube(), |s| (s.target.distance_m, s.target.mesh_unit_m) = (0.5, 1.0));
    let edge = half().cos();
    assert_close(found.diffuse.sum(), PI / (2.0 * 0.25) * (1.0 - edge.powi(4)), 1e-3);
}

#[test]
fn what_stands_behind_another_part_is_not_seen() {
    // A small cube in front of a large one: together no more than the large one without its middle, and the small one.
    let scaled = |size: f64, z: f64| {
        let corner = move |[x, y, w]: Point| [size * x, size * y, size * w + z];
        cube().triangles().iter().map(|triangle| triangle.map(corner)).collect::<Vec<_>>()
    };
    let (large_one, small_one) = (scaled(1.0, 0.0), scaled(0.2, 3.0));
    let at = |distance_m: f64| {
        move |s: &mut Scenario| (s.target.distance_m, s.target.mesh_unit_m) = (distance_m, 0.05)
    };
    // The front of the small cube is at 3.2, that of the large one at 1.
    let (near, far) = (0.5, 0.5 + 2.2 * 0.05);
    let small = seen(&of(small_one.clone()), at(near)).diffuse.sum();
    let large = seen(&of(large_one.clone()), at(far)).diffuse.sum();
    let hidden = returned(|s| {
        let side_m = 0.02 * far / near;
        (s.target.distance_m, s.target.extended) = (far, true);
        (s.target.length_m, s.target.width_m) = (side_m, side_m);
    });
    // Whichever comes first in the file.
    for both in [[large_one.clone(), small_one.clone()], [small_one, large_one]] {
        let found = seen(&of(both.concat()), at(near)).diffuse.sum();
        assert_close(found, large + small - hidden.diffuse.sum(), 1e-3);
        assert!(large + small > 1.01 * found, "it hides something");
    }
}

#[test]
fn the_front_of_a_mesh_is_where_its_file_has_the_largest_z() {
    let off = |[x, y, z]: Point| [x, y + if z > 0.0 { 3.0 } else { 0.0 }, z];
    let sheared = of(cube().triangles().iter().map(|triangle| triangle.map(off)).collect());
    // Its front face is 3 units up, as large as the cube's.
    let unit = |s: &mut Scenario| (s.target.distance_m, s.target.mesh_unit_m) = (0.5, 0.02);
    let found = seen(&sheared, unit);
    let front = returned(|s| {
        (s.target.length_m, s.target.width_m, s.target.offset_y_m) = (0.04, 0.04, 0.06);
    });
    let [near, _] = found.surface_ends_m().unwrap();
    let expected = (0.25f64 + 0.04 * 0.04).sqrt();
    assert_close(near, expected, 1e-3);
    assert!(found.diffuse.sum() > front.diffuse.sum(), "and its lower side is seen too");
    let up = seen(&sheared, |s| {
        unit(s);
        s.target.offset_y_m = -0.06;
    });
    let centred = returned(|s| {
        s.target.extended = true;
        (s.target.length_m, s.target.width_m) = (0.04, 0.04);
    });
    assert!(up.diffuse.sum() > 0.99 * centred.diffuse.sum());
}
