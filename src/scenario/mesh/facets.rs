//! Triangles as a file has them, with their places in it.

use crate::error::{Input, Result};

/// A point as the file has it: x to the right, y up, z towards the sensor.
pub type Point = [f64; 3];

/// Most triangles of a mesh.
const MOST_TRIANGLES: usize = 1_000_000;

/// Furthest that a corner may be from the origin, in the file's unit; the squares of what is further need not be numbers.
const FURTHEST: f64 = 1e6;

/// What a file has, before it is known to be a surface.
#[derive(Debug, Default)]
pub struct Facets {
    pub corners: Vec<[Point; 3]>,
    /// Where in the file each of them is.
    pub places: Vec<Place>,
}

/// A place in a file.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    /// A line of text, from 1.
    Line(usize),
    /// A triangle of a binary file, from 1.
    Triangle(usize),
}

impl Place {
    /// A fault there.
    pub fn fault(self, source: &str, expected: impl std::fmt::Display) -> Input {
        let fault = Input::new(source, expected);
        match self {
            Place::Line(line) => fault.at(line, 1),
            Place::Triangle(number) => fault.field(format!("triangle {number}")),
        }
    }
}

impl Facets {
    pub fn push(&mut self, source: &str, corners: [Point; 3], place: Place) -> Result<()> {
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

/// The lines of a text with their numbers, from 1; bytes that are no UTF-8 may stand in names and comments.
pub fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().map(|(line, text)| (line + 1, text))
}

/// The words of a line with their columns, from 1.
pub fn words(line: &str) -> impl Iterator<Item = (usize, &str)> {
    let column = |word: &str| word.as_ptr() as usize - line.as_ptr() as usize + 1;
    line.split_ascii_whitespace().map(move |word| (column(word), word))
}

/// Three numbers in a row.
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
