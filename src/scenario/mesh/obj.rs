//! Wavefront OBJ: corners (`v`) and faces (`f`). Colours, normals, textures and groups are ignored.
//!
//! A face with more than three corners is split into a fan from its first corner, which is correct for convex faces.

use crate::error::{Input, Result};

use super::facets::{FacetPlace, Facets, Point, lines, point, words};

/// Statements that are ignored, because they do not define the surface.
const PASSED_OVER: [&str; 14] = [
    "vt",
    "vn",
    "vp",
    "g",
    "o",
    "s",
    "mg",
    "l",
    "p",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "shadow_obj",
];

pub fn parse(source: &str, bytes: &[u8]) -> Result<Facets> {
    let text = String::from_utf8_lossy(bytes);
    let (mut corners, mut facets) = (Vec::new(), Facets::default());
    // A line that ends in a backslash goes on in the next one.
    let (mut pending, mut begin) = (String::new(), 0);
    for (line, text) in lines(&text) {
        let text = text.split('#').next().unwrap_or_default();
        begin = if pending.is_empty() { line } else { begin };
        if let Some(first) = text.trim_end().strip_suffix('\\') {
            pending += first;
            pending.push(' ');
            continue;
        }
        pending += text;
        statement(source, begin, &pending, &mut corners, &mut facets)?;
        pending.clear();
    }
    statement(source, begin, &pending, &mut corners, &mut facets)?;
    Ok(facets)
}

fn statement(
    source: &str,
    line: usize,
    text: &str,
    corners: &mut Vec<Point>,
    facets: &mut Facets,
) -> Result<()> {
    let mut words = words(text);
    match words.next() {
        None => {}
        Some((_, "v")) => corners.push(point(source, line, &mut words)?),
        Some((column, "f")) => {
            let mut face = Vec::new();
            for (column, word) in words {
                face.push(corner(corners, word).ok_or_else(|| {
                    let known = corners.len();
                    let expected = format!("expected one of the {known} corners before this line");
                    Input::new(source, expected).at(line, column).field("f").value(word)
                })?);
            }
            if face.len() < 3 {
                let fault = Input::new(source, "expected three corners or more").at(line, column);
                return Err(fault.field("f").value(face.len()).into());
            }
            for pair in face[1..].windows(2) {
                facets.push(source, [face[0], pair[0], pair[1]], FacetPlace::Line(line))?;
            }
        }
        Some((_, word)) if PASSED_OVER.contains(&word) => {}
        Some((column, word)) => {
            let expected = "expected a mesh of v and f, with vt, vn, g, o, s, usemtl or mtllib";
            return Err(Input::new(source, expected).at(line, column).value(word).into());
        }
    }
    Ok(())
}

/// Looks up the corner that `3`, `3/1`, `3//2` or `-1` refers to; negative numbers count back from the last corner.
fn corner(corners: &[Point], word: &str) -> Option<Point> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let index = match number {
        ..0 => corners.len().checked_sub(number.unsigned_abs() as usize)?,
        _ => usize::try_from(number.checked_sub(1)?).ok()?,
    };
    corners.get(index).copied()
}
