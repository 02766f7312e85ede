//! Integrals over the pixelated target: the fraction of the cone's light that it returns.
//!
//! The target is a rectangle perpendicular to the axis and centred on it; laser and sensor share one point. By
//! symmetry, one quadrant suffices. Its illuminated part is divided into sub-elements, and those that the edge of the
//! cone intersects count with the part of their row inside:
//!
//! ```text
//! y ^ ___
//!   |_____\      a row ends where it meets the circle R = d tan(angle / 2)
//!   |_______\
//!   |________|   or the target's edge
//!   +--------> x
//! ```
//!
//! Counting whole sub-elements by their centres, as the thesis does, has errors of up to 0.4 % at 400 per side; this
//! method has 0.005 % at 128.

use crate::scenario::Target;

/// Computes the sum of eq. 3.13: the target's elements, weighted with cos^2(theta) / (d_e^2 d_s^2), inside a cone of
/// the given full angle [1/m^2].
///
/// The cone is the narrower of field of illumination and field of view.
pub fn round_trip(target: &Target, full_angle_deg: f64) -> f64 {
    let axis = target.distance_m * target.distance_m;
    integrate(target, full_angle_deg, |r2| axis / (r2 * r2 * r2))
}

/// Computes the projected solid angle of the target inside the field of view, as seen from the lens [sr].
///
/// It is pi sin^2(FOV / 2) if the target covers the field of view.
pub fn projected_solid_angle(target: &Target, full_angle_deg: f64) -> f64 {
    let axis = target.distance_m * target.distance_m;
    integrate(target, full_angle_deg, |r2| axis / (r2 * r2))
}

/// Integrates a function of the squared distance [m^2] over the target inside the cone.
fn integrate(target: &Target, full_angle_deg: f64, f: impl Fn(f64) -> f64) -> f64 {
    let radius = target.distance_m * libm::tan((full_angle_deg / 2.0).to_radians());
    let (x_end, y_end) = (radius.min(target.length_m / 2.0), radius.min(target.width_m / 2.0));
    let (dx, dy) = (x_end / target.cells as f64, y_end / target.cells as f64);
    let mut sum = 0.0;
    for row in 0..target.cells {
        let y = (row as f64 + 0.5) * dy;
        let at_row = target.distance_m * target.distance_m + y * y;
        let row_end = (radius * radius - y * y).sqrt().min(x_end);
        let whole = ((row_end / dx) as u32).min(target.cells);
        let cut = row_end - whole as f64 * dx;
        let in_row = |x: f64| f(at_row + x * x);
        let cells = (0..whole).map(|cell| in_row((cell as f64 + 0.5) * dx)).sum::<f64>();
        sum += dy * (dx * cells + cut * in_row(row_end - cut / 2.0));
    }
    4.0 * sum
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn target(distance_m: f64, length_m: f64, width_m: f64, cells: u32) -> Target {
        Target { distance_m, length_m, width_m, cells, ..Target::default() }
    }

    fn assert_close(found: f64, expected: f64, relative: f64) {
        let error = found / expected - 1.0;
        assert!(error.abs() < relative, "{found} for {expected}, error {error:e}");
    }

    #[test]
    fn a_target_that_covers_the_cone_gives_the_closed_form() {
        let cos = |full_deg: f64| (full_deg / 2.0).to_radians().cos();
        for (d, size, full_deg) in
            [(0.001, 0.2, 21.0), (0.1, 0.2, 21.0), (0.53, 0.2, 21.0), (6.9, 10.0, 21.0)]
                .into_iter()
                .chain([(0.3, 100.0, 0.1), (0.3, 100.0, 90.0), (0.3, 100.0, 170.0)])
        {
            let target = target(d, size, size, 128);
            let expected = PI / (2.0 * d * d) * (1.0 - cos(full_deg).powi(4));
            assert_close(round_trip(&target, full_deg), expected, 1e-4);
            let expected = PI * (1.0 - cos(full_deg).powi(2));
            assert_close(projected_solid_angle(&target, full_deg), expected, 1e-4);
        }
    }

    #[test]
    fn a_clipped_cone_agrees_with_a_much_finer_grid() {
        for (d, length, width, full_deg) in [
            (0.6, 0.26, 0.20, 21.0),
            (0.6, 0.26, 0.20, 24.0),
            (6.9, 0.26, 0.20, 21.0),
            (0.6, 0.0001, 0.0001, 21.0),
            (0.6, 0.0001, 10.0, 21.0),
            (0.1, 0.26, 0.20, 120.0),
            (0.01, 0.26, 0.20, 170.0),
        ] {
            let coarse = target(d, length, width, 128);
            let fine = target(d, length, width, 3000);
            let expected = round_trip(&fine, full_deg);
            assert_close(round_trip(&coarse, full_deg), expected, 1e-4);
            let expected = projected_solid_angle(&fine, full_deg);
            assert_close(projected_solid_angle(&coarse, full_deg), expected, 1e-4);
        }
    }

    #[test]
    fn a_tiny_target_is_one_element() {
        let (d, side) = (0.6, 0.0001);
        let found = round_trip(&target(d, side, side, 8), 21.0);
        assert_close(found, side * side / (d * d * d * d), 1e-6);
    }

    #[test]
    fn the_side_of_the_default_target_clips_the_cone_at_0_6_m() {
        let clipped = round_trip(&target(0.6, 0.26, 0.20, 128), 21.0);
        let covered = round_trip(&target(0.6, 1.0, 1.0, 128), 21.0);
        assert_close(clipped / covered, 0.9638, 1e-3);
    }
}
