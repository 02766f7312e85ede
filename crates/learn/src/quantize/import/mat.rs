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
        let values = numbers(array.data());
        let values = values
            .ok_or_else(|| arrays.fault(array.name(), "expected real numbers, not complex ones"))?;
        arrays.put(array.name(), array.size().to_vec(), rows_first(array.size(), values));
    }
    Ok(arrays)
}

/// The values of a real array, `None` if it is complex.
fn numbers(data: &NumericData) -> Option<Vec<f64>> {
    use NumericData::*;
    match data {
        Double { real, imag: None } => Some(real.clone()),
        Single { real, imag: None } => Some(floats(real)),
        Int8 { real, imag: None } => Some(floats(real)),
        UInt8 { real, imag: None } => Some(floats(real)),
        Int16 { real, imag: None } => Some(floats(real)),
        UInt16 { real, imag: None } => Some(floats(real)),
        Int32 { real, imag: None } => Some(floats(real)),
        UInt32 { real, imag: None } => Some(floats(real)),
        Int64 { real, imag: None } => Some(real.iter().map(|&value| value as f64).collect()),
        UInt64 { real, imag: None } => Some(real.iter().map(|&value| value as f64).collect()),
        _ => None,
    }
}

fn floats<T: Copy + Into<f64>>(values: &[T]) -> Vec<f64> {
    values.iter().map(|&value| value.into()).collect()
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
