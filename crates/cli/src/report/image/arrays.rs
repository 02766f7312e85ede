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
/// Where the firmware looks for a second target.
const SECOND: [Measured; 2] = [
    ("second_radial_m", |one| one.second_radial_m()),
    ("second_sigma_m", |one| one.second_sigma_m()),
];
const EXPECTED: [Expected; 3] = [
    ("true_radial_m", |pixel| pixel.measured.expected.radial_m),
    ("signal", |pixel| pixel.measured.expected.signal_hits),
    ("ambient", |pixel| pixel.measured.expected.ambient_hits),
];

/// Values of an array.
pub enum ArrayValues {
    /// Numbers; NaN where there is none.
    Floats(Vec<f64>),
    /// Truth values.
    Bools(Vec<bool>),
    /// Sums of status bits.
    Words(Vec<u16>),
    /// Counts.
    Counts(Vec<u64>),
}

/// An array of some images, by row, then column.
pub struct ImageArray {
    /// Its name.
    pub name: &'static str,
    /// Rows and columns; what is measured has the images as a first axis if there are several.
    pub shape: Vec<usize>,
    /// Its values.
    pub values: ArrayValues,
}

impl DepthImages<'_> {
    /// Returns all arrays.
    pub fn arrays(&self) -> Vec<ImageArray> {
        let pixel = self.array.size().to_vec();
        let measured = match self.images {
            1 => pixel.clone(),
            count => [vec![count as usize], pixel.clone()].concat(),
        };
        let readings = self.readings();
        let floats = |values: Vec<Option<f64>>| {
            ArrayValues::Floats(values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect())
        };
        let seconds = SECOND.iter().filter(|_| self.looks_for_two());
        let of_readings = MEASURED
            .iter()
            .chain(seconds)
            .map(|(name, value)| (*name, &measured, floats(readings.iter().map(value).collect())));
        let of_pixels = EXPECTED
            .map(|(name, value)| (name, &pixel, floats(self.pixels.iter().map(value).collect())));
        let frames = || readings.iter().map(|one| one.frame);
        let valid = ArrayValues::Bools(frames().map(|frame| frame.valid).collect());
        let status = ArrayValues::Words(frames().map(|frame| frame.status.bits()).collect());
        let hits = ArrayValues::Counts(frames().map(|frame| frame.hits).collect());
        let others = [("valid", valid), ("status", status), ("hits", hits)];
        let others = others.into_iter().map(|(name, values)| (name, &measured, values));
        let all = of_readings.chain(of_pixels).chain(others);
        all.map(|(name, shape, values)| ImageArray { name, shape: shape.clone(), values }).collect()
    }
}

/// Returns all arrays in NumPy's format.
///
/// # Errors
/// When an array cannot be encoded.
pub fn all(images: &DepthImages) -> Result<Vec<NamedBytes>> {
    images.arrays().iter().map(encoded).collect()
}

fn encoded(array: &ImageArray) -> Result<NamedBytes> {
    let name = format!("{}.npy", array.name);
    let (kind, values): (_, Vec<u8>) = match &array.values {
        ArrayValues::Floats(all) => ("<f8", all.iter().flat_map(|one| one.to_le_bytes()).collect()),
        ArrayValues::Bools(all) => ("|b1", all.iter().map(|&one| u8::from(one)).collect()),
        ArrayValues::Words(all) => ("<u2", all.iter().flat_map(|one| one.to_le_bytes()).collect()),
        ArrayValues::Counts(all) => ("<u8", all.iter().flat_map(|one| one.to_le_bytes()).collect()),
    };
    let shape: Vec<_> = array.shape.iter().map(|&count| count as u64).collect();
    let mut bytes = Vec::new();
    array_header(&mut bytes, kind, &shape).map_err(|error| Input::new(&name, error))?;
    bytes.extend(values);
    Ok((name, bytes))
}
