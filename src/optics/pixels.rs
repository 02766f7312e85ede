//! Directions of an array's pixels.
//!
//! Pixels are equal squares or rectangles in the image plane; a radial distortion lies between them and the directions
//! that they see. Neighbours share their corners, so that the pixels cover the field of view without gaps.

use crate::scenario::projection::Projection;
use crate::scenario::{Array, Scenario};

use super::scene::outline::Outline;

/// Pixels by row, then column; row 0 is the top and column 0 the left, as seen from the sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    projection: Projection,
}

impl Pixels {
    /// Returns the pixels of a scenario; `None` for a single one that sees a cone.
    pub fn of(scenario: &Scenario) -> Option<Self> {
        let keys = &scenario.array;
        let cone_deg = scenario.laser.field_of_illumination_deg;
        keys.is_rectangular().then(|| Pixels::new(keys, cone_deg))
    }

    fn new(keys: &Array, cone_deg: f64) -> Self {
        let (rows, columns) = (keys.rows as usize, keys.columns as usize);
        Pixels { rows, columns, projection: Projection::of(keys, cone_deg) }
    }

    /// Returns the direction that is imaged at a place, in pixels from the left and from the top, in the plane one
    /// metre in front of the sensor [m].
    fn direction(&self, column: f64, row: f64) -> [f64; 2] {
        let [width, height] = self.projection.half;
        let x = width * (2.0 * column / self.columns as f64 - 1.0);
        let y = height * (1.0 - 2.0 * row / self.rows as f64);
        let image = x.hypot(y);
        let stretch = if image > 0.0 { self.projection.tangent(image) / image } else { 1.0 };
        [x * stretch, y * stretch]
    }

    /// Returns the direction of a pixel's middle, in the plane one metre in front of the sensor: to the right, and up
    /// [m].
    pub fn middle(&self, row: usize, column: usize) -> [f64; 2] {
        self.direction(column as f64 + 0.5, row as f64 + 0.5)
    }

    /// Returns the direction of a pixel's middle as a unit vector: to the right, down and forward [1].
    pub fn sight(&self, row: usize, column: usize) -> [f64; 3] {
        let [u, v] = self.middle(row, column);
        let length = (1.0 + u * u + v * v).sqrt();
        [u / length, -v / length, 1.0 / length]
    }

    /// Returns the focal length of the lens, in the width and in the height of a pixel [pixels].
    pub fn focal_pixels(&self) -> [f64; 2] {
        let [width, height] = self.projection.half;
        [self.columns as f64 / (2.0 * width), self.rows as f64 / (2.0 * height)]
    }

    /// Returns the full angles of the field of view across the middle row and the middle column [deg].
    pub fn field_of_view_deg(&self) -> [f64; 2] {
        let end = |image: f64| libm::atan(self.projection.tangent(image)).to_degrees();
        self.projection.half.map(|image| 2.0 * end(image))
    }

    /// Returns what a pixel sees.
    pub(super) fn outline(&self, row: usize, column: usize) -> Outline {
        let (x, y) = (column as f64, row as f64);
        let corners = [[x, y + 1.0], [x + 1.0, y + 1.0], [x + 1.0, y], [x, y]];
        Outline::Polygon(corners.map(|[x, y]| self.direction(x, y)).to_vec())
    }

    /// Returns the number of the pixel that sees a direction, if one does.
    pub(super) fn seeing(&self, u: f64, v: f64) -> Option<usize> {
        let tangent = u.hypot(v);
        let stretch = if tangent > 0.0 { self.projection.image(tangent) / tangent } else { 1.0 };
        let [width, height] = self.projection.half;
        let column = (u * stretch / width + 1.0) / 2.0 * self.columns as f64;
        let row = (1.0 - v * stretch / height) / 2.0 * self.rows as f64;
        let is_inside =
            (0.0..self.columns as f64).contains(&column) && (0.0..self.rows as f64).contains(&row);
        is_inside.then(|| row as usize * self.columns + column as usize)
    }

    /// Returns the ends of the field of view, to the right and up, in the plane one metre in front of the sensor [m].
    pub(super) fn ends(&self) -> [[f64; 2]; 2] {
        let (columns, rows) = (self.columns as f64, self.rows as f64);
        let edges = (0..=64).map(|part| f64::from(part) / 64.0);
        let around = edges.flat_map(|part| {
            [
                [part * columns, 0.0],
                [part * columns, rows],
                [0.0, part * rows],
                [columns, part * rows],
            ]
        });
        let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for [column, row] in around {
            for (end, at) in ends.iter_mut().zip(self.direction(column, row)) {
                *end = [end[0].min(at), end[1].max(at)];
            }
        }
        ends
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(rows: u32, columns: u32, change: impl FnOnce(&mut Array)) -> Pixels {
        let mut keys = Array { rows, columns, ..Array::default() };
        change(&mut keys);
        Pixels::new(&keys, 21.0)
    }

    #[test]
    fn the_largest_rectangle_of_square_pixels_has_its_corners_on_the_cone() {
        let pixels = pixels(40, 30, |_| ());
        let [us, vs] = pixels.ends();
        let reach = 10.5f64.to_radians().tan();
        assert!((us[1].hypot(vs[1]) / reach - 1.0).abs() < 1e-12, "{us:?} {vs:?}");
        assert!(((us[1] - us[0]) / 30.0 - (vs[1] - vs[0]) / 40.0).abs() < 1e-12);
        let [u, v] = pixels.middle(0, 0);
        assert!(u < 0.0 && v > 0.0, "the first pixel is at the top left");
    }

    #[test]
    fn a_direction_is_seen_by_the_pixel_whose_outline_holds_it() {
        for distortion in [[0.0, 0.0], [-0.3, 0.1], [0.4, 0.0]] {
            let pixels = pixels(6, 8, |keys| {
                keys.distortion = distortion;
                keys.field_of_view_deg = Some([60.0, 45.0]);
            });
            for (row, column) in (0..6).flat_map(|row| (0..8).map(move |column| (row, column))) {
                let [u, v] = pixels.middle(row, column);
                assert_eq!(pixels.seeing(u, v), Some(row * 8 + column), "{distortion:?}");
                let span = pixels.outline(row, column).spans(v)[0];
                assert!(span[0] < u && u < span[1]);
            }
            assert_eq!(pixels.seeing(0.6, 0.0), None);
        }
    }

    #[test]
    fn the_field_of_view_is_that_of_the_keys_whatever_the_distortion() {
        for distortion in [[0.0, 0.0], [-0.2, 0.05]] {
            let pixels = pixels(3, 5, |keys| {
                keys.distortion = distortion;
                keys.field_of_view_deg = Some([50.0, 30.0]);
            });
            let [u, _] = pixels.direction(5.0, 1.5);
            assert!((u - 25f64.to_radians().tan()).abs() < 1e-12, "{distortion:?}: {u}");
        }
    }
}
