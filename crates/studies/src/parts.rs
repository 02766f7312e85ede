//! Intermediate Parquet files with the finished points of an unfinished sweep.

use std::fs;
use std::path::{Path, PathBuf};

use tofsim::error::{Error, Result};
use tofsim::files::output::create_directory;

use crate::table::{Field, Row, parquet_file};

/// A folder of such files, one per block of finished points.
pub struct Parts {
    folder: PathBuf,
    fields: Vec<Field>,
}

impl Parts {
    /// Uses the folder `sweep.parts` within `folder`; earlier files in it are kept.
    pub fn new(folder: &Path, fields: Vec<Field>) -> Self {
        Parts { folder: folder.join("sweep.parts"), fields }
    }

    /// Writes a block of rows, in order of their points.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn add(&self, mut rows: Vec<Row>) -> Result<()> {
        rows.sort_by_key(|row| row.point);
        let Some(first) = rows.first() else { return Ok(()) };
        create_directory(&self.folder)?;
        let path = self.folder.join(format!("from-{:09}.parquet", first.point));
        let mut file = parquet_file::create(&path, &self.fields, Vec::new())?;
        file.write(&rows)?;
        file.finish()?.commit()
    }

    /// Deletes the folder.
    ///
    /// # Errors
    /// If it cannot be deleted.
    pub fn remove(&self) -> Result<()> {
        match fs::remove_dir_all(&self.folder) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                Err(Error::io(&self.folder, "remove")(error))
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::reader::TableReader;
    use crate::table::{Cell, Kind};

    #[test]
    fn a_part_is_a_table_of_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let fields = vec![Field::new("point", Kind::Whole), Field::new("hits", Kind::Number)];
        let parts = Parts::new(folder.path(), fields);
        let row = |point| Row { point, cells: vec![Cell::Whole(point), Cell::Number(0.5)] };
        parts.add(vec![row(8), row(7)]).unwrap();
        let path = folder.path().join("sweep.parts/from-000000007.parquet");
        let mut table = TableReader::open(&path).unwrap();
        assert_eq!(table.next_row().unwrap(), Some(row(7)));
        assert_eq!(table.next_row().unwrap(), Some(row(8)));
        parts.remove().unwrap();
        assert!(!path.exists() && folder.path().exists());
        parts.remove().unwrap();
    }
}
