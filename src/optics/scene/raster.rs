//! Rasterization of a mesh as seen from the sensor: the nearest triangle on each line of sight is visible.
//!
//! Laser and sensor share one point, so that each illuminated point is visible and vice versa. Details smaller than a
//! raster cell count only if they cover the cell's centre.

use crate::scenario::Target;
use crate::scenario::mesh::Mesh;

use super::element::{Cell, Element};
use super::outline::{Vector, common, dot};
use super::surface::{Body, Kind, Pose};

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

    /// Passes the visible elements inside a cone of the given full angle to `take`.
    pub fn elements(&self, full_angle_deg: f64, cells: u32, mut take: impl FnMut(Element)) {
        let reach = libm::tan((full_angle_deg / 2.0).to_radians());
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
        let raster = Raster { us, vs, side };
        let nearest = raster.nearest(&self.0);
        for (place, triangle) in nearest.iter().enumerate() {
            let Some(triangle) = triangle.checked_sub(1) else { continue };
            let cell = raster.cell(place);
            if cell.u.hypot(cell.v) < reach {
                let triangle = &self.0[triangle as usize];
                let normal = normal(triangle);
                let length = dot(&normal, &normal).sqrt();
                let plane = Body::plane(&triangle[0], normal.map(|part| part / length));
                take(cell.element(Kind::Diffuse, |u, v| plane.hit(u, v)));
            }
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
    side: usize,
}

impl Raster {
    fn cell(&self, place: usize) -> Cell {
        let size = |ends: [f64; 2]| (ends[1] - ends[0]) / self.side as f64;
        let (du, dv) = (size(self.us), size(self.vs));
        let middle = |from: f64, size: f64, k: usize| from + (k as f64 + 0.5) * size;
        let u = middle(self.us[0], du, place % self.side);
        Cell { u, v: middle(self.vs[0], dv, place / self.side), du, dv }
    }

    /// Returns for each cell the number, from 1, of the nearest triangle on the line of sight through its centre; 0
    /// if there is none.
    fn nearest(&self, triangles: &[[Vector; 3]]) -> Vec<u32> {
        let mut found = vec![(f64::INFINITY, 0); self.side * self.side];
        for (number, triangle) in triangles.iter().enumerate() {
            let seen = triangle.map(|[x, y, z]| [x / z, y / z]);
            let normal = normal(triangle);
            let plane = dot(&normal, &triangle[0]);
            let [rows, columns] = [(1, self.vs), (0, self.us)].map(|(axis, ends)| {
                let places = seen.map(|corner| {
                    (corner[axis] - ends[0]) / (ends[1] - ends[0]) * self.side as f64 - 0.5
                });
                let low = places.into_iter().fold(f64::INFINITY, f64::min).ceil().max(0.0);
                let high = places.into_iter().fold(f64::NEG_INFINITY, f64::max).floor();
                low as usize..(high + 1.0).clamp(0.0, self.side as f64) as usize
            });
            for row in rows {
                for column in columns.clone() {
                    let place = row * self.side + column;
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
