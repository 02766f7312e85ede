//! Images as NumPy arrays.

use tofsim::error::{Input, Result};
use tofsim_learn::dataset::npy::array_header;

use crate::report::sheet::NamedBytes;

use super::readings::{DepthImages, ImagePixel, Reading};

/// A value of a reading, and the array that it is in.
type Measured = (&'static str, fn(&Reading) -> Option<f64>);
/// A value that a pixel has in every image, and the array that it is in.
type Expected = (&'static str, fn(&ImagePixel) -> Option<f64>);

const MEASURED: [Measured; 3] = [
    ("depth_radial_m", |one| one.radial_m()),
    ("depth_perpendicular_m", |one| one.perpendicular_m()),
    ("sigma_m", |one| one.sigma_m()),
];
const EXPECTED: [Expected; 3] = [
    ("true_radial_m", |pixel| pixel.measured.expected.radial_m),
    ("signal", |pixel| pixel.measured.expected.signal_hits),
    ("ambient", |pixel| pixel.measured.expected.ambient_hits),
];

/// Returns all arrays: rows x columns; what is measured has the images as a first axis if there are several.
///
/// # Errors
/// When an array cannot be encoded.
pub fn all(images: &DepthImages) -> Result<Vec<NamedBytes>> {
    let [rows, columns] = images.array.size().map(|count| count as u64);
    let shape = match images.images {
        1 => vec![rows, columns],
        count => vec![count, rows, columns],
    };
    let (shape, one) = (shape.as_slice(), &[rows, columns][..]);
    let readings = images.readings();
    let mut files = Vec::new();
    for (name, value) in MEASURED {
        files.push(array(name, "<f8", shape, readings.iter().map(|one| bits(value(one))))?);
    }
    for (name, value) in EXPECTED {
        files.push(array(name, "<f8", one, images.pixels.iter().map(|one| bits(value(one))))?);
    }
    let valid = readings.iter().map(|one| [u8::from(one.frame.valid)]);
    files.push(array("valid", "|b1", shape, valid)?);
    let status = readings.iter().map(|one| one.frame.status.bits().to_le_bytes());
    files.push(array("status", "<u2", shape, status)?);
    let hits = readings.iter().map(|one| one.frame.hits.to_le_bytes());
    files.push(array("hits", "<u8", shape, hits)?);
    Ok(files)
}

/// Returns the bytes of a number; NaN where there is none.
fn bits(value: Option<f64>) -> [u8; 8] {
    value.unwrap_or(f64::NAN).to_le_bytes()
}

fn array<const N: usize>(
    name: &str,
    kind: &str,
    shape: &[u64],
    values: impl Iterator<Item = [u8; N]>,
) -> Result<NamedBytes> {
    let name = format!("{name}.npy");
    let mut bytes = Vec::new();
    array_header(&mut bytes, kind, shape).map_err(|error| Input::new(&name, error))?;
    bytes.extend(values.flatten());
    Ok((name, bytes))
}
