//! Surfaces of a target as seen from the sensor.

use crate::scenario::{Shape, Target};

use super::outline::{Outline, Vector, dot};

/// Distance from the sensor below which a plane is seen edge-on and returns no light [m].
const EDGE_ON_M: f64 = 1e-9;

/// Kind of reflection on a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Diffuse reflection by Lambert's law.
    Diffuse,
    /// Retroreflection.
    Retro,
    /// Diffuse reflection of a surface that shares the lines of sight with the target.
    Second,
}

/// A surface, and the outlines that hide parts of it.
#[derive(Clone, Debug)]
pub struct Surface {
    pub kind: Kind,
    pub outline: Outline,
    pub body: Body,
    /// Outlines within which the surface is hidden or absent.
    pub hidden_by: Vec<Outline>,
}

impl Surface {
    /// Returns the same as a second surface.
    pub fn second(self) -> Self {
        Surface { kind: Kind::Second, ..self }
    }
}

/// Geometry at which a line of sight ends.
#[derive(Clone, Copy, Debug)]
pub enum Body {
    /// A plane, by its distance and unit normal.
    Plane { from_m: f64, normal: Vector },
    /// The near side of a sphere.
    Sphere { centre: Vector, radius_m: f64 },
}

impl Body {
    /// Creates the plane through a point.
    pub fn plane(point: &Vector, normal: Vector) -> Self {
        Body::Plane { from_m: dot(point, &normal), normal }
    }

    /// Returns the length of the line of sight through (u, v, 1) [m], and the cosine of its angle to the surface's
    /// normal [1].
    pub fn hit(&self, u: f64, v: f64) -> [f64; 2] {
        let sight = [u, v, 1.0];
        let length = dot(&sight, &sight).sqrt();
        match self {
            Body::Plane { from_m, normal } => {
                let cos = (dot(&sight, normal) / length).abs();
                [from_m.abs() / cos, cos]
            }
            Body::Sphere { centre, radius_m } => {
                let along = dot(&sight, centre) / length;
                let beside = dot(centre, centre) - along * along;
                let half = (radius_m * radius_m - beside).max(0.0).sqrt();
                [along - half, half / radius_m]
            }
        }
    }
}

/// Rotation and translation of a target, from coordinates relative to its centre: x to the right, y up, z away from
/// the sensor.
pub struct Pose {
    yaw: [f64; 2],
    tilt: [f64; 2],
    moved: Vector,
}

impl Pose {
    /// Creates the pose of a target whose centre is at a distance [m].
    pub fn new(target: &Target, distance_m: f64) -> Self {
        let sincos = |deg: f64| [libm::sin(deg.to_radians()), libm::cos(deg.to_radians())];
        Pose {
            yaw: sincos(target.yaw_deg),
            tilt: sincos(target.tilt_deg),
            moved: [target.offset_x_m, target.offset_y_m, distance_m],
        }
    }

    /// Rotates a direction.
    pub fn turned(&self, [x, y, z]: &Vector) -> Vector {
        let [sin, cos] = self.yaw;
        let (x, z) = (cos * x - sin * z, sin * x + cos * z);
        let [sin, cos] = self.tilt;
        [x, cos * y - sin * z, sin * y + cos * z]
    }

    /// Rotates and translates a point.
    pub fn placed(&self, point: &Vector) -> Vector {
        let turned = self.turned(point);
        [0, 1, 2].map(|axis| turned[axis] + self.moved[axis])
    }
}

/// Returns the surfaces of a target; none for a mesh.
pub fn surfaces(target: &Target) -> Vec<Surface> {
    let pose = Pose::new(target, target.distance_m);
    let (x, y) = (target.length_m / 2.0, target.width_m / 2.0);
    let whole = || Panel { pose: &pose, x: [-x, x], y: [-y, y], z: 0.0 };
    let flat: Vec<_> = match target.shape {
        Shape::Mesh => return vec![],
        Shape::Sphere => return sphere(target).into_iter().collect(),
        Shape::Rectangle => whole().surface(Kind::Diffuse).into_iter().collect(),
        Shape::Disc => disc(target, &pose).into_iter().collect(),
        Shape::Step => {
            let edge = target.edge_m.clamp(-x, x);
            let behind = target.second_distance_m - target.distance_m;
            let first = Panel { x: [-x, edge], ..whole() };
            let second = Panel { x: [edge, x], z: behind, ..whole() };
            return nearer_first(first.surface(Kind::Diffuse), second.surface(Kind::Diffuse));
        }
    };
    let half = target.retro_side_m / 2.0;
    let (patch_x, patch_y) = (target.retro_x_m, target.retro_y_m);
    let is_round = target.shape == Shape::Disc;
    let within = |centre: f64, end: f64| {
        if is_round {
            [centre - half, centre + half]
        } else {
            [(centre - half).max(-end), (centre + half).min(end)]
        }
    };
    let patch = Panel { x: within(patch_x, x), y: within(patch_y, y), ..whole() };
    let patch = patch.surface(Kind::Retro);
    let around = flat.into_iter().map(|surface| Surface {
        hidden_by: patch.iter().map(|patch| patch.outline.clone()).collect(),
        ..surface
    });
    around.chain(patch.clone()).collect()
}

/// A flat rectangle, relative to the target's centre [m].
struct Panel<'a> {
    pose: &'a Pose,
    x: [f64; 2],
    y: [f64; 2],
    z: f64,
}

impl Panel<'_> {
    /// Returns the rectangle as a surface; `None` if it is not visible.
    fn surface(&self, kind: Kind) -> Option<Surface> {
        let ([left, right], [low, high]) = (self.x, self.y);
        let corners = [[left, low], [right, low], [right, high], [left, high]];
        let corners = corners.map(|[x, y]| self.pose.placed(&[x, y, self.z]));
        let body = Body::plane(&corners[0], self.pose.turned(&[0.0, 0.0, -1.0]));
        let outline = Outline::of_corners(&corners).filter(|_| left < right && low < high)?;
        is_seen(&body).then_some(Surface { kind, outline, body, hidden_by: vec![] })
    }
}

fn is_seen(body: &Body) -> bool {
    !matches!(body, Body::Plane { from_m, .. } if from_m.abs() < EDGE_ON_M)
}

fn disc(target: &Target, pose: &Pose) -> Option<Surface> {
    let (centre, normal) = (pose.placed(&[0.0; 3]), pose.turned(&[0.0, 0.0, -1.0]));
    let outline = Outline::of_disc(&centre, &normal, target.radius_m);
    let body = Body::plane(&centre, normal);
    is_seen(&body).then_some(Surface { kind: Kind::Diffuse, outline, body, hidden_by: vec![] })
}

fn sphere(target: &Target) -> Option<Surface> {
    let radius_m = target.radius_m;
    let centre = [target.offset_x_m, target.offset_y_m, target.distance_m + radius_m];
    let outline = Outline::of_sphere(&centre, radius_m);
    let body = Body::Sphere { centre, radius_m };
    Some(Surface { kind: Kind::Diffuse, outline, body, hidden_by: vec![] })
}

/// Orders two parallel panels so that the nearer one hides the other.
fn nearer_first(one: Option<Surface>, other: Option<Surface>) -> Vec<Surface> {
    let from = |surface: &Surface| match surface.body {
        Body::Plane { from_m, .. } => from_m.abs(),
        Body::Sphere { .. } => 0.0,
    };
    let mut both: Vec<_> = [one, other].into_iter().flatten().collect();
    both.sort_by(|a, b| from(a).total_cmp(&from(b)));
    if let [near, far] = both.as_mut_slice() {
        far.hidden_by.push(near.outline.clone());
    }
    both
}
