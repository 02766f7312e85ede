//! CSV with a row for each instant.

use std::io;
use std::path::Path;

use csv::Writer;

use tofsim::error::{Error, Result};
use tofsim::files::output::OutputFile;
use tofsim::waves::dump::{Dump, DumpValue};

use super::columns::Columns;

/// A CSV file under construction.
pub(super) struct CsvDump {
    file: Writer<OutputFile>,
    columns: Columns,
    events: Vec<usize>,
    /// Present row, and its time.
    row: Vec<String>,
    at: Option<u64>,
}

impl CsvDump {
    pub(super) fn create(path: &Path, columns: Columns) -> Result<CsvDump> {
        let mut file = Writer::from_writer(OutputFile::create(path)?);
        let time = columns.unit.map_or("sample".to_owned(), |unit| format!("time_{unit}"));
        let names = columns.signals.iter().map(|signal| &signal.name.text);
        let header = file.write_record([&time].into_iter().chain(names));
        header.map_err(|error| file.get_ref().fault(error.into()))?;
        let (row, events) = (vec![String::new(); columns.signals.len()], columns.events());
        Ok(CsvDump { file, columns, events, row, at: None })
    }

    fn end_row(&mut self) -> io::Result<()> {
        let Some(at) = self.at.take() else { return Ok(()) };
        let time = self.columns.time(at).to_string();
        self.file.write_record([&time].into_iter().chain(&self.row))?;
        self.events.iter().for_each(|&event| self.row[event].clear());
        Ok(())
    }
}

impl Dump for CsvDump {
    fn begin(&mut self, at: u64) -> io::Result<()> {
        if self.at != Some(at) {
            self.end_row()?;
            self.at = Some(at);
        }
        Ok(())
    }

    fn change(&mut self, id: usize, value: DumpValue<'_>) -> io::Result<()> {
        self.row[id] = self.columns.text(id, value);
        Ok(())
    }

    fn finish(mut self: Box<Self>, at: u64) -> Result<()> {
        let ended = self.begin(at).and_then(|()| self.end_row());
        ended.map_err(|error| self.file.get_ref().fault(error))?;
        let target = self.file.get_ref().target().to_owned();
        let file = self.file.into_inner().map_err(|error| error.into_error());
        file.map_err(Error::io(&target, "write"))?.commit()
    }
}
