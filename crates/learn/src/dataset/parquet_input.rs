//! Opening of Parquet files: what can be read, and what is damaged.

use std::fs::File;
use std::io::Read;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use parquet::basic::Compression;
use parquet::file::reader::{FileReader, SerializedFileReader};

use tofsim::error::open::open_file;
use tofsim::error::{Error, Input, Result};

use super::parquet_checksum::is_intact;

/// First bytes of a Parquet file.
const MAGIC: &[u8; 4] = b"PAR1";

/// Returns whether a path is a Parquet file. What is not a file, such as a pipe, is none; its bytes stay unread.
///
/// # Errors
/// If the file cannot be read.
pub(super) fn is_parquet(path: &Path) -> Result<bool> {
    if !path.metadata().map_err(Error::io(path, "read"))?.is_file() {
        return Ok(false);
    }
    let mut first = Vec::new();
    let file = open_file(path)?.take(MAGIC.len() as u64).read_to_end(&mut first);
    file.map_err(Error::io(path, "read"))?;
    Ok(first == MAGIC)
}

/// Opens a file, and checks its checksum if it has one.
///
/// # Errors
/// If it cannot be read, is damaged, or is compressed in a way that cannot be read.
pub fn open(path: &Path) -> Result<SerializedFileReader<File>> {
    let mut file = open_file(path)?;
    if !is_intact(&mut file).map_err(Error::io(path, "read"))? {
        let expected = "its bytes do not match its checksum (tofsim.crc32); expected the file as tofsim wrote it";
        return Err(damaged(path, expected));
    }
    guarded(path, || {
        let file = SerializedFileReader::new(file).map_err(|error| damaged(path, error))?;
        let groups = file.metadata().row_groups().iter();
        let mut columns = groups.flat_map(|group| group.columns());
        let unread = columns.find(|column| !is_read(column.compression()));
        match unread {
            None => Ok(file),
            Some(column) => {
                let expected = "expected no compression, or Snappy, gzip, LZ4 or Zstandard";
                let fault = Input::new(path.display(), expected);
                let field = format!("compression of column {}", column.column_path().string());
                // Its level does not matter.
                let name = column.compression().to_string();
                let name = name.split('(').next().unwrap_or_default();
                Err(fault.field(field).value(name).into())
            }
        }
    })
}

/// Runs `read`, which uses the library; a panic of the library over a damaged file becomes an error.
///
/// # Errors
/// If `read` fails or panics.
pub fn guarded<T>(path: &Path, read: impl FnOnce() -> Result<T>) -> Result<T> {
    let read = catch_unwind(AssertUnwindSafe(read));
    read.unwrap_or_else(|_| Err(damaged(path, "its pages are not as its header says")))
}

/// Creates the error for a damaged file.
pub fn damaged(path: &Path, error: impl std::fmt::Display) -> Error {
    Input::new(path.display(), format!("unreadable Parquet: {error}")).into()
}

/// Returns whether the library was built with a compression. Brotli would take seven seconds of building for files
/// that are hardly ever met.
fn is_read(compression: Compression) -> bool {
    use Compression::*;
    matches!(compression, UNCOMPRESSED | SNAPPY | GZIP(_) | LZ4 | LZ4_RAW | ZSTD(_))
}
