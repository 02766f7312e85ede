//! Check that triangles form a closed surface with outward normals.

use std::collections::HashMap;

use crate::error::{Input, Result};

use super::facets::{Facets, Point};

/// Triangles that share an edge.
#[derive(Clone, Copy, Default)]
struct Sides {
    /// Triangles that use the edge forwards, minus backwards.
    excess: i32,
    all: u32,
    /// Index of one of the triangles.
    triangle: usize,
}

/// Checks that every edge is used equally often in both directions, and that the enclosed volume is positive.
///
/// # Errors
/// The line or triangle at fault, with the edge or the volume and what was expected.
pub fn check(source: &str, facets: &Facets) -> Result<()> {
    let mut edges: HashMap<[[u64; 3]; 2], Sides> = HashMap::new();
    let mut volume = 0.0;
    for (triangle, corners) in facets.corners.iter().enumerate() {
        volume += signed_volume(corners);
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let (from, to) = (key(&corners[from]), key(&corners[to]));
            if from != to {
                let sides = edges.entry([from.min(to), from.max(to)]).or_default();
                sides.excess += if from < to { 1 } else { -1 };
                (sides.all, sides.triangle) = (sides.all + 1, triangle);
            }
        }
    }
    let open = edges.iter().filter(|(_, sides)| sides.excess != 0);
    if let Some((ends, sides)) = open.min_by_key(|(ends, sides)| (sides.triangle, **ends)) {
        let [from, to] = ends.map(|end| end.map(f64::from_bits));
        let expected = match sides.all {
            1 => "expected a closed mesh, with another triangle at this edge".to_owned(),
            all => format!(
                "expected a closed mesh, corners counter-clockwise from outside: the {all} triangles at this edge do \
                 not go along it as often one way as the other"
            ),
        };
        let edge = format!("{from:?} to {to:?}");
        return Err(facets.places[sides.triangle].fault(source, expected).value(edge).into());
    }
    if volume > 0.0 {
        return Ok(());
    }
    let why = if volume < 0.0 { "the mesh is inside out" } else { "there is nothing in the mesh" };
    let expected =
        format!("expected more than 0, with corners counter-clockwise from outside: {why}");
    Err(Input::new(source, expected).field("volume").value(volume).into())
}

/// Computes six times the signed volume of the tetrahedron between a triangle and the origin.
fn signed_volume([a, b, c]: &[Point; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Returns the bits of a corner's coordinates, with negative zero mapped to zero.
fn key(point: &Point) -> [u64; 3] {
    point.map(|number| (number + 0.0).to_bits())
}
