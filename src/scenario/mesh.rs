//! Triangle meshes of a target: Wavefront OBJ, and STL in ASCII or binary.

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

/// A closed triangle mesh, in the file's units. Corners are counter-clockwise as seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    triangles: Vec<[Point; 3]>,
}

impl Mesh {
    /// Returns the triangles.
    pub fn triangles(&self) -> &[[Point; 3]] {
        &self.triangles
    }
}

/// Loads the mesh of a target, if its shape is one. The path is relative to `base`.
///
/// # Errors
/// If the file cannot be read, or is not a closed surface with outward normals.
pub fn load(target: &Target, base: &Source) -> Result<Option<Arc<Mesh>>> {
    let (Shape::Mesh, Some(name)) = (target.shape, &target.mesh_file) else { return Ok(None) };
    let (source, bytes) = base.read_bytes(name)?;
    parse(&source, &bytes).map(|mesh| Some(Arc::new(mesh)))
}

/// Parses a mesh; the extension of `source` selects the format.
///
/// # Errors
/// If it is not a closed surface with outward normals.
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
