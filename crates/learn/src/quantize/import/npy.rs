//! Arrays from a folder of NumPy files, one an array, named after it.

use std::fs;
use std::io::BufReader;
use std::path::Path;

use npyz::{DType, Order, TypeChar};

use tofsim::error::open::open_file;
use tofsim::error::{Error, Input, Result};
use tofsim::files::npy;

use super::arrays::Arrays;

/// Largest array that is read [numbers].
const LARGEST: u64 = 1 << 20;

/// Reads the `.npy` files of a folder.
pub(super) fn read(folder: &Path) -> Result<Arrays> {
    let mut arrays = Arrays::new(folder.display());
    for entry in fs::read_dir(folder).map_err(Error::io(folder, "read"))? {
        let path = entry.map_err(Error::io(folder, "read"))?.path();
        if path.extension().is_some_and(|ending| ending == "npy")
            && let Some(name) = path.file_stem().and_then(|stem| stem.to_str())
        {
            let (shape, values) = array(&path)?;
            arrays.put(name, shape, values);
        }
    }
    Ok(arrays)
}

fn array(path: &Path) -> Result<(Vec<usize>, Vec<f64>)> {
    let file = open_file(path)?;
    let fault = |expected: String| Error::from(Input::new(path.display(), expected));
    let npy = npy::open(BufReader::new(file));
    let npy = npy.map_err(|error| fault(format!("unreadable .npy: {error}")))?;
    let shape = npy.shape().to_vec();
    let count = shape.iter().try_fold(1u64, |count, &len| count.checked_mul(len));
    if count.is_none_or(|count| count > LARGEST) {
        return Err(fault(format!("expected {LARGEST} numbers at most")));
    }
    if npy.order() != Order::C && shape.iter().filter(|&&len| len > 1).count() > 1 {
        return Err(fault("expected C order, as numpy.ascontiguousarray has it".to_owned()));
    }
    let real = matches!(npy.dtype(), DType::Plain(ty) if ty.type_char() == TypeChar::Float);
    let values = match npy.dtype() {
        DType::Plain(ty) if real && ty.size_field() == 4 => {
            npy.into_vec::<f32>().map(|values| values.into_iter().map(f64::from).collect())
        }
        _ if real => npy.into_vec::<f64>(),
        other => return Err(fault(format!("{}: expected f4 or f8", other.descr()))),
    };
    let values = values.map_err(|error| fault(format!("unreadable .npy: {error}")))?;
    Ok((shape.iter().map(|&len| len as usize).collect(), values))
}
