//! Arrays from a MATLAB file of level 5 (`save -v7` or `-v6`): numeric arrays, by name.

use std::io::Read;
use std::path::Path;

use matfile::{MatFile, NumericData};

use tofsim::error::open::open;
use tofsim::error::{Error, Input, Result};

use super::arrays::Arrays;
use super::unpack::{LARGEST, unpacked};

/// Reads a file; what is no numeric array in it, such as the network object itself, is passed over.
pub(super) fn read(path: &Path) -> Result<Arrays> {
    let mut bytes = Vec::new();
    let file = open(path)?.take(LARGEST as u64 + 1).read_to_end(&mut bytes);
    file.map_err(Error::io(path, "read"))?;
    let bytes = unpacked(&bytes).map_err(|expected| Input::new(path.display(), expected))?;
    let mat = MatFile::parse(&bytes[..]).map_err(|error| {
        let expected = format!("not a MATLAB file of level 5 ({error:?}); save with -v7");
        Input::new(path.display(), expected)
    })?;
    let mut arrays = Arrays::new(path.display());
    for array in mat.arrays() {
        let Some(values) = numbers(array.data()) else { continue };
        arrays.put(array.name(), array.size().to_vec(), rows_first(array.size(), values));
    }
    Ok(arrays)
}

/// The values of a real array.
fn numbers(data: &NumericData) -> Option<Vec<f64>> {
    match data {
        NumericData::Double { real, imag: None } => Some(real.clone()),
        NumericData::Single { real, imag: None } => Some(real.iter().map(|&v| v.into()).collect()),
        NumericData::UInt8 { real, imag: None } => Some(real.iter().map(|&v| v.into()).collect()),
        NumericData::Int16 { real, imag: None } => Some(real.iter().map(|&v| v.into()).collect()),
        NumericData::UInt16 { real, imag: None } => Some(real.iter().map(|&v| v.into()).collect()),
        NumericData::Int32 { real, imag: None } => Some(real.iter().map(|&v| v.into()).collect()),
        _ => None,
    }
}

/// MATLAB has the first index fastest.
fn rows_first(size: &[usize], values: Vec<f64>) -> Vec<f64> {
    match *size {
        [rows, columns] if values.len() == rows * columns => {
            let at = |place: usize| values[place % columns * rows + place / columns];
            (0..values.len()).map(at).collect()
        }
        _ => values,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_become_rows() {
        let values = rows_first(&[2, 3], vec![1.0, 4.0, 2.0, 5.0, 3.0, 6.0]);
        assert_eq!(values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }
}
