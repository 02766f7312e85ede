//! Outlines as seen from the sensor, in the plane one metre in front of it: `u` to the right, `v` up.
//!
//! A point (x, y, z) is seen at (x / z, y / z). A polygon remains a polygon; discs and spheres appear as the inside
//! of a conic. Both intersect a row of constant `v` in spans of `u` with a closed form.

/// Start and end of a part of a row.
pub type Span = [f64; 2];

/// A vector, or a point: to the right, up, away from the sensor [m].
pub type Vector = [f64; 3];

/// Distance within which parts beside or behind the sensor are cut off [m].
const NEAREST_M: f64 = 1e-6;

pub fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Boundary of a visible region.
#[derive(Clone, Debug)]
pub enum Outline {
    /// Convex polygon, by its corners in order.
    Polygon(Vec<[f64; 2]>),
    /// Conic w' form w <= 0 with w = (u, v, 1), on the side to which `ahead` points.
    Conic { form: [Vector; 3], ahead: Vector },
}

impl Outline {
    /// Returns the outline of a flat convex polygon; `None` if all of it is behind the sensor.
    pub fn of_corners(corners: &[Vector]) -> Option<Self> {
        let mut ahead = Vec::new();
        for (k, a) in corners.iter().enumerate() {
            let b = &corners[(k + 1) % corners.len()];
            if a[2] >= NEAREST_M {
                ahead.push([a[0] / a[2], a[1] / a[2]]);
            }
            if (a[2] < NEAREST_M) != (b[2] < NEAREST_M) {
                let part = (NEAREST_M - a[2]) / (b[2] - a[2]);
                let cut = |axis: usize| (a[axis] + part * (b[axis] - a[axis])) / NEAREST_M;
                ahead.push([cut(0), cut(1)]);
            }
        }
        (ahead.len() > 2).then_some(Outline::Polygon(ahead))
    }

    /// Returns the outline of a disc with the given centre, unit normal and radius [m]. The squared distance from the
    /// centre to the intersection of a line of sight with the plane, times the squared cosine, is a quadratic form.
    pub fn of_disc(centre: &Vector, normal: &Vector, radius_m: f64) -> Self {
        let plane = dot(centre, normal);
        let square = dot(centre, centre) - radius_m * radius_m;
        let form = symmetric(|i, j| {
            let unit = if i == j { plane * plane } else { 0.0 };
            unit - plane * (centre[i] * normal[j] + normal[i] * centre[j])
                + square * normal[i] * normal[j]
        });
        let ahead = normal.map(|part| part * plane.signum());
        Outline::Conic { form, ahead }
    }

    /// Returns the outline of a sphere that does not contain the sensor.
    pub fn of_sphere(centre: &Vector, radius_m: f64) -> Self {
        let square = dot(centre, centre) - radius_m * radius_m;
        let form = symmetric(|i, j| if i == j { square } else { 0.0 } - centre[i] * centre[j]);
        Outline::Conic { form, ahead: *centre }
    }

    /// Returns the range of rows that may intersect the outline.
    pub fn rows(&self) -> Span {
        match self {
            Outline::Polygon(corners) => {
                let rows = corners.iter().map(|corner| corner[1]);
                [rows.clone().fold(f64::INFINITY, f64::min), rows.fold(f64::NEG_INFINITY, f64::max)]
            }
            Outline::Conic { form: q, .. } => {
                let endless = [f64::NEG_INFINITY, f64::INFINITY];
                let a = q[0][1] * q[0][1] - q[0][0] * q[1][1];
                let b = 2.0 * (q[0][1] * q[0][2] - q[0][0] * q[1][2]);
                let c = q[0][2] * q[0][2] - q[0][0] * q[2][2];
                match (a < 0.0 && q[0][0] > 0.0).then(|| roots(-a, -b, -c)).flatten() {
                    Some(ends) => ends,
                    None => endless,
                }
            }
        }
    }

    /// Returns the parts of a row inside the outline.
    pub fn spans(&self, v: f64) -> Vec<Span> {
        match self {
            Outline::Polygon(corners) => {
                let mut span = [f64::INFINITY, f64::NEG_INFINITY];
                for (k, a) in corners.iter().enumerate() {
                    let b = &corners[(k + 1) % corners.len()];
                    if (a[1] <= v) != (b[1] <= v) {
                        let u = a[0] + (v - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                        span = [span[0].min(u), span[1].max(u)];
                    }
                }
                if span[0] < span[1] { vec![span] } else { vec![] }
            }
            Outline::Conic { form: q, ahead } => {
                let a = q[0][0];
                let b = 2.0 * (q[0][1] * v + q[0][2]);
                let c = (q[1][1] * v + 2.0 * q[1][2]) * v + q[2][2];
                let [low, high] = [f64::NEG_INFINITY, f64::INFINITY];
                let inside = match roots(a, b, c) {
                    Some(ends) if a > 0.0 => vec![ends],
                    Some([first, last]) => vec![[low, first], [last, high]],
                    None if a > 0.0 => vec![],
                    None => vec![[low, high]],
                };
                let border = -(ahead[1] * v + ahead[2]) / ahead[0];
                let front = match ahead[0] {
                    0.0 if ahead[1] * v + ahead[2] > 0.0 => [low, high],
                    0.0 => return vec![],
                    0.0.. => [border, high],
                    _ => [low, border],
                };
                inside.iter().filter_map(|span| common(span, &front)).collect()
            }
        }
    }
}

/// Returns the intersection of two spans.
pub fn common(a: &Span, b: &Span) -> Option<Span> {
    let both = [a[0].max(b[0]), a[1].min(b[1])];
    (both[0] < both[1]).then_some(both)
}

/// Returns the parts of a span outside of another.
pub fn without(span: &Span, other: &Span) -> Vec<Span> {
    let left = [span[0], span[1].min(other[0])];
    let right = [span[0].max(other[1]), span[1]];
    [left, right].into_iter().filter(|part| part[0] < part[1]).collect()
}

fn symmetric(of: impl Fn(usize, usize) -> f64) -> [Vector; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| of(i, j)))
}

/// Returns the two roots of a quadratic polynomial, in ascending order.
fn roots(a: f64, b: f64, c: f64) -> Option<Span> {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant <= 0.0 || a == 0.0 {
        return None;
    }
    // So that no two numbers of a size are subtracted.
    let sum = -0.5 * (b + discriminant.sqrt().copysign(b));
    let (one, other) = (sum / a, if sum == 0.0 { 0.0 } else { c / sum });
    Some([one.min(other), one.max(other)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(found: Span, expected: Span) {
        let near = |k: usize| (found[k] - expected[k]).abs() < 1e-12;
        assert!(near(0) && near(1), "{found:?} for {expected:?}");
    }

    #[test]
    fn a_square_is_seen_under_its_angle() {
        let corners = [[-1.0, -1.0, 2.0], [1.0, -1.0, 2.0], [1.0, 1.0, 2.0], [-1.0, 1.0, 2.0]];
        let outline = Outline::of_corners(&corners).unwrap();
        assert_near(outline.rows(), [-0.5, 0.5]);
        assert_near(outline.spans(0.3)[0], [-0.5, 0.5]);
        assert!(outline.spans(0.6).is_empty());
    }

    #[test]
    fn what_reaches_behind_the_sensor_is_cut_off_there() {
        let corners = [[1.0, -1.0, -2.0], [1.0, -1.0, 2.0], [1.0, 1.0, 2.0], [1.0, 1.0, -2.0]];
        let spans = Outline::of_corners(&corners).unwrap().spans(0.25);
        assert!((spans[0][0] - 0.5).abs() < 1e-9 && spans[0][1] > 1e4, "{spans:?}");
        assert!(Outline::of_corners(&corners.map(|[x, y, z]| [x, y, z - 3.0])).is_none());
    }

    #[test]
    fn a_disc_and_a_sphere_on_the_axis_are_seen_as_circles() {
        let disc = Outline::of_disc(&[0.0, 0.0, 2.0], &[0.0, 0.0, -1.0], 1.0);
        assert_near(disc.rows(), [-0.5, 0.5]);
        assert_near(disc.spans(0.3)[0], [-0.4, 0.4]);
        let sphere = Outline::of_sphere(&[0.0, 0.0, 2.0], 1.0);
        let edge = 1.0 / 3f64.sqrt();
        assert_near(sphere.rows(), [-edge, edge]);
        assert_near(sphere.spans(0.0)[0], [-edge, edge]);
        assert!(sphere.spans(0.6).is_empty());
    }

    #[test]
    fn the_edge_of_a_turned_disc_is_where_its_circle_is_seen() {
        let (centre, radius) = ([0.2, -0.1, 1.5], 0.4);
        let (sin, cos) = (0.6f64, 0.8f64);
        let disc = Outline::of_disc(&centre, &[sin, 0.0, -cos], radius);
        for step in 0..60 {
            let angle = f64::from(step) * 0.1047;
            let (x, y) = (radius * angle.cos(), radius * angle.sin());
            let point = [centre[0] + cos * x, centre[1] + y, centre[2] + sin * x];
            let (u, v) = (point[0] / point[2], point[1] / point[2]);
            let rows = disc.rows();
            assert!((rows[0] - 1e-9..=rows[1] + 1e-9).contains(&v));
            let ends = disc.spans(v).first().copied().unwrap_or([u; 2]);
            let off = ends.iter().map(|end| (end - u).abs()).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-6, "{step}: {u} in {ends:?}");
        }
    }

    #[test]
    fn a_span_without_a_part_of_it_is_what_is_left_on_either_side() {
        assert_eq!(without(&[0.0, 9.0], &[2.0, 3.0]), [[0.0, 2.0], [3.0, 9.0]]);
        assert_eq!(without(&[0.0, 9.0], &[-2.0, 3.0]), [[3.0, 9.0]]);
        assert_eq!(without(&[0.0, 9.0], &[-2.0, 30.0]), [[0.0; 2]; 0]);
        assert_eq!(without(&[0.0, 9.0], &[10.0, 30.0]), [[0.0, 9.0]]);
    }
}
