//! The files of a dataset, together: all of them are put in place, or none is begun.

use std::io::Write;
use std::path::{Path, PathBuf};

use tofsim::error::Result;
use tofsim::files::output::{OutputFile, create_directory};

use super::blocks::Sample;
use super::description::DatasetDescription;
use super::format::TABLE;
use super::grid::Grid;
use super::npy::{self, NpyFiles};
use super::parquet_file;
use super::parquet_table::ParquetTable;

pub use super::format::DatasetFormat;

/// The file with the description alone.
pub const DESCRIPTION: &str = "dataset.json";

/// The files under construction.
pub struct DatasetFiles {
    json: OutputFile,
    parquet: Option<ParquetTable<Sample>>,
    npy: NpyFiles,
    grid: Grid,
}

impl DatasetFiles {
    /// Begins the files of a dataset of a grid in a folder, which is made.
    pub fn create(
        folder: &Path,
        formats: &[DatasetFormat],
        description: &DatasetDescription,
        grid: &Grid,
    ) -> Result<Self> {
        create_directory(folder)?;
        let mut json = OutputFile::create(&folder.join(DESCRIPTION))?;
        let text = serde_json::to_string(description).map_err(std::io::Error::from);
        let text = text.map_err(|error| json.fault(error))?;
        writeln!(json, "{text}").map_err(|error| json.fault(error))?;
        let wants = |format| formats.contains(&format);
        let parquet = || parquet_file::create(&folder.join(TABLE), (description, &text), grid);
        let npy = || npy::create(folder, description, grid);
        Ok(DatasetFiles {
            json,
            parquet: wants(DatasetFormat::Parquet).then(parquet).transpose()?,
            npy: wants(DatasetFormat::Npy).then(npy).transpose()?.unwrap_or_default(),
            grid: grid.clone(),
        })
    }

    /// Adds rows.
    pub fn write(&mut self, samples: &[Sample]) -> Result<()> {
        self.parquet.as_mut().map_or(Ok(()), |parquet| parquet.write(samples))?;
        npy::write(&mut self.npy, samples, &self.grid)
    }

    /// Puts the files in place and returns their paths.
    pub fn finish(self) -> Result<Vec<PathBuf>> {
        let mut files = self.npy.files;
        files.extend(self.parquet.map(ParquetTable::finish).transpose()?);
        files.push(self.json);
        let paths = files.iter().map(|file| file.target().to_owned()).collect();
        for file in &mut files {
            file.flush().map_err(|error| file.fault(error))?;
        }
        files.into_iter().try_for_each(OutputFile::commit)?;
        Ok(paths)
    }
}
