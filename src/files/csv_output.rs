//! CSV tables as output: the provenance in the first line, followed by the header and the rows.

use std::path::Path;

use crate::error::{Error, Result};
use crate::files::output::OutputFile;

/// A CSV file under construction, which is removed unless it is finished.
pub struct CsvOutput {
    writer: csv::Writer<OutputFile>,
    path: std::path::PathBuf,
}

impl CsvOutput {
    /// Begins a file with columns of these names; `comment` is its first line, including the line feed.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn create<'a>(
        path: &Path,
        comment: &str,
        names: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self> {
        use std::io::Write;
        let mut file = OutputFile::create(path)?;
        file.write_all(comment.as_bytes()).map_err(Error::io(path, "write"))?;
        let mut csv = CsvOutput { writer: csv::Writer::from_writer(file), path: path.to_owned() };
        csv.record(names)?;
        Ok(csv)
    }

    /// Writes the cells of a row.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn record(&mut self, cells: impl IntoIterator<Item = impl AsRef<[u8]>>) -> Result<()> {
        let written = self.writer.write_record(cells);
        written.map_err(|error| Error::io(&self.path, "write")(std::io::Error::other(error)))
    }

    /// Completes the file, and moves it to its final path.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn finish(self) -> Result<()> {
        let file = self.writer.into_inner();
        file.map_err(|error| Error::io(&self.path, "write")(error.into_error()))?.commit()
    }
}
