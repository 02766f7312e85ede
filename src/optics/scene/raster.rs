//! Rasterization of a mesh as seen from the sensor: the nearest triangle on each line of sight is visible.
//!
//! Laser and sensor share one point, so that each illuminated point is visible and vice versa. Details smaller than a
//! raster cell count only if they cover the cell's centre.

use crate::scenario::Target;
use crate::scenario::mesh::Mesh;

use crate::optics::pixels::Pixels;

use super::element::{Cell, Element};
use super::outline::{Vector, common, dot};
use super::surface::{Body, Kind, Pose};
use super::view::View;

/// Number of raster cells per cell of the scenario key.
const FINER: u32 = 8;
/// Largest number of raster cells per side.
const MOST: u32 = 4096;

/// Triangles that face the sensor, at the target's position.
#[derive(Clone, Debug)]
pub struct Placed(Vec<[Vector; 3]>);

impl Placed {
    /// Places a mesh such that its nearest point is at the target's distance.
    pub fn new(mesh: &Mesh, target: &Target) -> Self {
        let (pose, unit_m) = (Pose::new(target, 0.0), target.mesh_unit_m);
        // The file's z points towards the sensor, which turns what goes counter-clockwise.
        let placed = |[x, y, z]: &Vector| pose.placed(&[x * unit_m, y * unit_m, -z * unit_m]);
        let mut triangles: Vec<_> =
            mesh.triangles().iter().map(|[a, b, c]| [placed(a), placed(c), placed(b)]).collect();
        let nearest = triangles.as_flattened().iter().map(|corner| corner[2]);
        let behind = target.distance_m - nearest.fold(f64::INFINITY, f64::min);
        triangles.as_flattened_mut().iter_mut().for_each(|corner| corner[2] += behind);
        triangles.retain(|triangle| dot(&normal(triangle), &triangle[0]) < 0.0);
        Placed(triangles)
    }

    /// Passes the visible elements inside a cone to `take`.
    pub fn elements(&self, cone: &View, cells: u32, mut take: impl FnMut(Element)) {
        let reach = cone.reach();
        let side = (cells * FINER).min(MOST) as usize;
        let axis = |axis: usize| {
            let seen = self.0.as_flattened().iter().map(move |corner| corner[axis] / corner[2]);
            let ends = [
                seen.clone().fold(f64::INFINITY, f64::min),
                seen.fold(f64::NEG_INFINITY, f64::max),
            ];
            common(&ends, &[-reach, reach])
        };
        let (Some(us), Some(vs)) = (axis(0), axis(1)) else { return };
        let raster = Raster { us, vs, sides: [side; 2] };
        self.visible(&raster, |[u, v], element| {
            if u.hypot(v) < reach {
                take(element());
            }
        });
    }

    /// Passes the visible elements in the field of view of an array, with the place of each, to `take`. A pixel has
    /// whole cells, as long as the lens does not distort.
    pub fn elements_of(
        &self,
        pixels: &Pixels,
        cells: u32,
        mut take: impl FnMut([f64; 2], Element),
    ) {
        let [us, vs] = pixels.ends();
        let longest = pixels.rows.max(pixels.columns);
        let cells = ((cells * FINER).min(MOST) as usize).div_ceil(longest);
        let raster = Raster { us, vs, sides: [pixels.columns * cells, pixels.rows * cells] };
        self.visible(&raster, |place, element| take(place, element()));
    }

    /// Passes the place of each cell that shows a triangle to `take`, with its element.
    fn visible(&self, raster: &Raster, mut take: impl FnMut([f64; 2], &dyn Fn() -> Element)) {
        for (place, triangle) in raster.nearest(&self.0).iter().enumerate() {
            let Some(triangle) = triangle.checked_sub(1) else { continue };
            let cell = raster.cell(place);
            take([cell.u, cell.v], &|| {
                let triangle = &self.0[triangle as usize];
                let normal = normal(triangle);
                let length = dot(&normal, &normal).sqrt();
                let plane = Body::plane(&triangle[0], normal.map(|part| part / length));
                cell.element(Kind::Diffuse, |u, v| plane.hit(u, v))
            });
        }
    }
}

/// Returns the normal of a triangle on the side from which its corners are counter-clockwise, not normalized.
fn normal([a, b, c]: &[Vector; 3]) -> Vector {
    let [b, c] = [b, c].map(|corner| [0, 1, 2].map(|axis| corner[axis] - a[axis]));
    [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]]
}

/// A grid of equal cells over a part of the view.
struct Raster {
    us: [f64; 2],
    vs: [f64; 2],
    /// Number of columns and of rows.
    sides: [usize; 2],
}

impl Raster {
    fn cell(&self, place: usize) -> Cell {
        let [columns, rows] = self.sides;
        let size = |ends: [f64; 2], count: usize| (ends[1] - ends[0]) / count as f64;
        let (du, dv) = (size(self.us, columns), size(self.vs, rows));
        let middle = |from: f64, size: f64, k: usize| from + (k as f64 + 0.5) * size;
        let u = middle(self.us[0], du, place % columns);
        Cell { u, v: middle(self.vs[0], dv, place / columns), du, dv }
    }

    /// Returns for each cell the number, from 1, of the nearest triangle on the line of sight through its centre; 0
    /// if there is none.
    fn nearest(&self, triangles: &[[Vector; 3]]) -> Vec<u32> {
        let mut found = vec![(f64::INFINITY, 0); self.sides[0] * self.sides[1]];
        for (number, triangle) in triangles.iter().enumerate() {
            let seen = triangle.map(|[x, y, z]| [x / z, y / z]);
            let normal = normal(triangle);
            let plane = dot(&normal, &triangle[0]);
            let [columns, rows] = [(0, self.us), (1, self.vs)].map(|(axis, ends)| {
                let side = self.sides[axis] as f64;
                let places =
                    seen.map(|corner| (corner[axis] - ends[0]) / (ends[1] - ends[0]) * side - 0.5);
                let low = places.into_iter().fold(f64::INFINITY, f64::min).ceil().max(0.0);
                let high = places.into_iter().fold(f64::NEG_INFINITY, f64::max).floor();
                low as usize..(high + 1.0).clamp(0.0, side) as usize
            });
            for row in rows {
                for column in columns.clone() {
                    let place = row * self.sides[0] + column;
                    let Cell { u, v, .. } = self.cell(place);
                    if !holds(&seen, u, v) {
                        continue;
                    }
                    let depth = plane / dot(&normal, &[u, v, 1.0]);
                    if depth < found[place].0 {
                        found[place] = (depth, number as u32 + 1);
                    }
                }
            }
        }
        found.into_iter().map(|(_, number)| number).collect()
    }
}

/// Returns whether a point is inside a triangle or on its edge.
fn holds(corners: &[[f64; 2]; 3], u: f64, v: f64) -> bool {
    let side = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) * (v - a[1]) - (b[1] - a[1]) * (u - a[0]);
    let [a, b, c] = *corners;
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}
