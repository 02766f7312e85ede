//! Datasets from files, their own or made by others with the same columns or arrays.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use tofsim::error::{Error, Input, Result};

use super::blocks::Sample;
use super::{npy, npy_read, parquet_file, parquet_read};

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
