//! STL, in ASCII or binary. The file's normals are ignored: the orientation of the corners defines the outside, and
//! agrees with the normals in a valid file.

use crate::error::{Input, Result};

use super::facets::{FacetPlace, Facets, Point, lines, point, words};

/// Length of the header of a binary file [bytes].
const HEADER: usize = 80;
/// Offset of the first triangle of a binary file [bytes].
const FIRST: usize = HEADER + 4;
/// Size of a triangle: normal, three corners and an unused attribute [bytes].
const TRIANGLE: usize = 50;
/// Offset of the corners in a triangle [bytes].
const CORNERS: usize = 12;

pub fn parse(source: &str, bytes: &[u8]) -> Result<Facets> {
    // Binary files may begin with `solid` too; their length tells.
    let count = bytes.get(HEADER..FIRST).and_then(|count| count.try_into().ok());
    let count = count.map_or(0, |count| u32::from_le_bytes(count) as usize);
    let is_binary = bytes.len() >= FIRST && bytes.len() - FIRST == count.saturating_mul(TRIANGLE);
    match bytes.trim_ascii_start().get(..5) {
        _ if is_binary => binary(source, &bytes[FIRST..]),
        Some(word) if word.eq_ignore_ascii_case(b"solid") => {
            ascii(source, &String::from_utf8_lossy(bytes))
        }
        _ => {
            let expected = format!(
                "expected text that begins with `solid`, or {FIRST} + {TRIANGLE} n bytes of which those from \
                 {HEADER} on say n = {count}"
            );
            Err(Input::new(source, expected).value(format!("{} bytes", bytes.len())).into())
        }
    }
}

fn binary(source: &str, triangles: &[u8]) -> Result<Facets> {
    let mut facets = Facets::default();
    for (index, triangle) in triangles.chunks_exact(TRIANGLE).enumerate() {
        let place = FacetPlace::Triangle(index + 1);
        let mut corners = [[0.0; 3]; 3];
        let words = triangle[CORNERS..].chunks_exact(4);
        for (place_of, word) in corners.as_flattened_mut().iter_mut().zip(words) {
            let number = f32::from_le_bytes([word[0], word[1], word[2], word[3]]);
            if !number.is_finite() {
                let fault = place.fault(source, "expected finite numbers");
                return Err(fault.value(number).into());
            }
            *place_of = f64::from(number);
        }
        facets.push(source, corners, place)?;
    }
    Ok(facets)
}

fn ascii(source: &str, text: &str) -> Result<Facets> {
    let (mut facets, mut corners) = (Facets::default(), Vec::<Point>::new());
    for (line, text) in lines(text) {
        let mut words = words(text);
        let Some((column, word)) = words.next() else { continue };
        match word.to_ascii_lowercase().as_str() {
            "vertex" => corners.push(point(source, line, &mut words)?),
            "facet" => corners.clear(),
            "endfacet" => {
                let found = <[Point; 3]>::try_from(std::mem::take(&mut corners));
                let three = found.map_err(|found| {
                    let fault = Input::new(source, "expected three `vertex` in a facet");
                    fault.at(line, column).value(found.len())
                })?;
                facets.push(source, three, FacetPlace::Line(line))?;
            }
            "solid" | "endsolid" | "outer" | "endloop" => {}
            _ => {
                let expected =
                    "expected solid, facet, outer loop, vertex, endloop, endfacet or endsolid";
                return Err(Input::new(source, expected).at(line, column).value(word).into());
            }
        }
    }
    if corners.is_empty() {
        Ok(facets)
    } else {
        Err(Input::new(source, "expected `endfacet` before the end").into())
    }
}
