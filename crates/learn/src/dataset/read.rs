//! Datasets from files, their own or made by others with the same columns or arrays.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use tofsim::error::{Error, Input, Result};
use tofsim::network::{Histogram, MAX_HITS};

use super::{Sample, Scene, npy, npy_read, parquet_file, parquet_read};

/// First bytes of a Parquet file.
const PARQUET: &[u8; 4] = b"PAR1";

/// Reads a dataset: a Parquet file, or the folder of one or of arrays. All of it is in memory, about
/// 560 bytes a row.
///
/// # Errors
/// When a file cannot be read, a column is missing, has another type or holds what is no value of it,
/// or the number of bins is not 256.
pub fn read(path: &Path) -> Result<Vec<Sample>> {
    if !path.is_dir() {
        let mut first = Vec::new();
        let file = File::open(path).map_err(Error::io(path, "read"))?;
        file.take(4).read_to_end(&mut first).map_err(Error::io(path, "read"))?;
        if first == PARQUET {
            return parquet_read::read(path);
        }
        let expected = "expected a Parquet file, or the folder of a dataset";
        return Err(Input::new(path.display(), expected).into());
    }
    let (table, arrays) = (path.join(parquet_file::NAME), path.join(npy::NAMES[0]));
    match (table.exists(), arrays.exists()) {
        (true, _) => parquet_read::read(&table),
        (_, true) => npy_read::read(path),
        _ => {
            let [histograms, truth, rows] = npy::NAMES;
            let table = parquet_file::NAME;
            let expected = format!("expected {table}, or {histograms}, {truth} and {rows} in it");
            Err(Input::new(path.display(), expected).into())
        }
    }
}

/// What is wrong with a row: the column, what stands there and what was expected.
pub(super) type Fault = (String, String, String);

/// Refuses what no scene has.
pub(super) fn check_truth(scene: &Scene) -> std::result::Result<(), Fault> {
    let values = [scene.distance_m, scene.reflectance, scene.irradiance_w_m2_nm];
    for (name, value) in parquet_file::HEAD[2..].iter().zip(values) {
        if !(0.0..=f64::MAX).contains(&value) {
            let column = format!("column {name}");
            return Err((column, value.to_string(), "expected a number from 0".to_owned()));
        }
    }
    Ok(())
}

/// Refuses what the estimator's words do not bear.
pub(super) fn check_total(histogram: &Histogram) -> std::result::Result<(), Fault> {
    let total: u32 = histogram.iter().map(|&count| u32::from(count)).sum();
    if total > MAX_HITS {
        let expected = format!("the estimator's bit widths allow {MAX_HITS} hits in all");
        return Err(("total".to_owned(), total.to_string(), expected));
    }
    Ok(())
}
