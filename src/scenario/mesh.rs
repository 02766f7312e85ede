//! The triangles of a target from a file: Wavefront OBJ, or STL in ASCII or binary.

mod closed;
mod facets;
mod obj;
mod stl;

use std::path::Path;
use std::sync::Arc;

use crate::error::{Input, Result};

use super::builtin::Source;
use super::model::{Shape, Target};

pub use facets::Point;

/// A closed surface, in the file's units; seen from outside, corners go counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    triangles: Vec<[Point; 3]>,
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

/// The mesh of a file whose name tells its format.
///
/// # Errors
/// When it holds no closed surface with its outside outside.
pub fn parse(source: &str, bytes: &[u8]) -> Result<Mesh> {
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

#[cfg(test)]
pub mod tests;
