//! Triangles of a mesh file, with their positions in it.

use crate::error::{Input, Result};

/// A corner in the file's unit: x to the right, y up, z towards the sensor.
pub type Point = [f64; 3];

/// Largest number of triangles of a mesh.
const MOST_TRIANGLES: usize = 1_000_000;

/// Largest coordinate of a corner, in the file's unit; squares of larger numbers might overflow.
const FURTHEST: f64 = 1e6;

/// Triangles of a file, not yet checked to form a surface.
#[derive(Debug, Default)]
pub struct Facets {
    pub corners: Vec<[Point; 3]>,
    /// Position of each triangle in the file.
    pub places: Vec<FacetPlace>,
}

/// A position in a file.
#[derive(Clone, Copy, Debug)]
pub enum FacetPlace {
    /// Line number of a text file, from 1.
    Line(usize),
    /// Triangle number of a binary file, from 1.
    Triangle(usize),
}

impl FacetPlace {
    /// Creates an error at this position.
    pub fn fault(self, source: &str, expected: impl std::fmt::Display) -> Input {
        let fault = Input::new(source, expected);
        match self {
            FacetPlace::Line(line) => fault.at(line, 1),
            FacetPlace::Triangle(number) => fault.field(format!("triangle {number}")),
        }
    }
}

impl Facets {
    pub fn push(&mut self, source: &str, corners: [Point; 3], place: FacetPlace) -> Result<()> {
        if self.corners.len() == MOST_TRIANGLES {
            let expected = format!("expected {MOST_TRIANGLES} triangles at most");
            return Err(place.fault(source, expected).into());
        }
        if let Some(far) = corners.as_flattened().iter().find(|number| number.abs() > FURTHEST) {
            let expected = format!("expected coordinates of {FURTHEST} at most");
            return Err(place.fault(source, expected).value(format!("{far:e}")).into());
        }
        self.corners.push(corners);
        self.places.push(place);
        Ok(())
    }
}

/// Splits a text into lines, numbered from 1. Names and comments that are not UTF-8 are replaced.
pub fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().map(|(line, text)| (line + 1, text))
}

/// Splits a line into words, with their columns from 1.
pub fn words(line: &str) -> impl Iterator<Item = (usize, &str)> {
    let column = |word: &str| word.as_ptr() as usize - line.as_ptr() as usize + 1;
    line.split_ascii_whitespace().map(move |word| (column(word), word))
}

/// Parses three numbers as a point.
pub fn point<'a>(
    source: &str,
    line: usize,
    words: &mut impl Iterator<Item = (usize, &'a str)>,
) -> Result<Point> {
    let mut point = [0.0; 3];
    for (place, axis) in point.iter_mut().zip(["x", "y", "z"]) {
        let fault =
            |column| Input::new(source, "expected a finite number").at(line, column).field(axis);
        let Some((column, word)) = words.next() else { return Err(fault(1).into()) };
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        *place = number.ok_or_else(|| fault(column).value(word))?;
    }
    Ok(point)
}
