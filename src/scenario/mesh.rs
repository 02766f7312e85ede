//! The triangles of a target from a file: Wavefront OBJ, or STL in ASCII or binary.

mod closed;
mod obj;
mod stl;

use std::path::Path;
use std::sync::Arc;

use crate::error::{Input, Result};

use super::builtin::Source;
use super::model::{Shape, Target};

/// A point as the file has it: x to the right, y up, z towards the sensor.
pub type Point = [f64; 3];

/// Most triangles of a mesh.
const MOST_TRIANGLES: usize = 1_000_000;

/// A closed surface, in the file's units; seen from outside, corners go counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    triangles: Vec<[Point; 3]>,
}

/// What a file has, before it is known to be a surface.
#[derive(Debug, Default)]
struct Facets {
    corners: Vec<[Point; 3]>,
    /// Where in the file each of them is.
    places: Vec<Place>,
}

/// A place in a file.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// A line of text, from 1.
    Line(usize),
    /// A triangle of a binary file, from 1.
    Triangle(usize),
}

impl Place {
    /// A fault there.
    fn fault(self, source: &str, expected: impl std::fmt::Display) -> Input {
        let fault = Input::new(source, expected);
        match self {
            Place::Line(line) => fault.at(line, 1),
            Place::Triangle(number) => fault.field(format!("triangle {number}")),
        }
    }
}

impl Facets {
    fn push(&mut self, source: &str, corners: [Point; 3], place: Place) -> Result<()> {
        if self.corners.len() == MOST_TRIANGLES {
            let expected = format!("expected {MOST_TRIANGLES} triangles at most");
            return Err(place.fault(source, expected).into());
        }
        self.corners.push(corners);
        self.places.push(place);
        Ok(())
    }
}

impl Mesh {
    /// Its triangles.
    pub fn triangles(&self) -> &[[Point; 3]] {
        &self.triangles
    }
}

/// The mesh of a target, if that is one; its path is taken from `base`.
///
/// # Errors
/// When the file cannot be read, or holds no closed surface with its outside outside.
pub fn load(target: &Target, base: &Source) -> Result<Option<Arc<Mesh>>> {
    let (Shape::Mesh, Some(name)) = (target.shape, &target.mesh_file) else { return Ok(None) };
    let (source, bytes) = base.read_bytes(name)?;
    parse(&source, &bytes).map(|mesh| Some(Arc::new(mesh)))
}

fn parse(source: &str, bytes: &[u8]) -> Result<Mesh> {
    let ending = Path::new(source).extension().map(|ending| ending.to_ascii_lowercase());
    let facets = match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("obj") => obj::parse(source, bytes)?,
        Some("stl") => stl::parse(source, bytes)?,
        _ => return Err(Input::new(source, "expected a name that ends in .obj or .stl").into()),
    };
    if facets.corners.is_empty() {
        return Err(Input::new(source, "expected one triangle at least").into());
    }
    closed::check(source, &facets)?;
    Ok(Mesh { triangles: facets.corners })
}

/// The lines of a text with their numbers, from 1; bytes that are no UTF-8 may stand in names and comments.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().map(|(line, text)| (line + 1, text))
}

/// The words of a line with their columns, from 1.
fn words(line: &str) -> impl Iterator<Item = (usize, &str)> {
    let column = |word: &str| word.as_ptr() as usize - line.as_ptr() as usize + 1;
    line.split_ascii_whitespace().map(move |word| (column(word), word))
}

/// Three numbers in a row.
fn point<'a>(
    source: &str,
    line: usize,
    words: &mut impl Iterator<Item = (usize, &'a str)>,
) -> Result<Point> {
    let mut point = [0.0; 3];
    for (place, axis) in point.iter_mut().zip(["x", "y", "z"]) {
        let fault = |column| {
            Input::new(source, "expected a finite number").at(line, column).field(axis)
        };
        let Some((column, word)) = words.next() else { return Err(fault(1).into()) };
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        *place = number.ok_or_else(|| fault(column).value(word))?;
    }
    Ok(point)
}

#[cfg(test)]
pub mod tests;
