//! `tofsim.ila`: captures of logic analysers as arrays.

use std::path::PathBuf;

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use tofsim::error::{Input, poll_stop};
use tofsim_captures::ila::Radix;
use tofsim_captures::ila::read::{CaptureForm, CaptureRow, Column, open};
use tofsim_cli::choice::RADIX;

use crate::arrays::table;
use crate::errors::Result;
use crate::running::{self, Terms};

/// Samples between two looks at whether to stop.
const BETWEEN: usize = 1 << 10;

/// The radix of that name.
pub fn radix_of(name: Option<&str>) -> Result<Option<Radix>> {
    let Some(name) = name else { return Ok(None) };
    let found = RADIX.iter().find(|(word, ..)| *word == name);
    let known = || RADIX.iter().map(|(word, ..)| *word).collect::<Vec<_>>().join(", ");
    let fault = || Input::new("radix", format!("expected one of {}", known())).value(name);
    Ok(Some(found.ok_or_else(fault)?.1))
}

/// Contents of a file.
struct Read {
    form: CaptureForm,
    columns: Vec<Column>,
    notes: Vec<String>,
    values: Vec<Vec<u64>>,
    unknown: Vec<Vec<u64>>,
    samples: usize,
    windows: Vec<u64>,
    triggers: Vec<u64>,
    gaps: Vec<u64>,
}

/// Reads a capture; the parts of a `tofsim.ila.Capture` as a dictionary.
#[pyfunction]
#[pyo3(name = "_read_ila", signature = (path, radix = None))]
pub fn read_ila<'py>(
    py: Python<'py>,
    path: PathBuf,
    radix: Option<&str>,
) -> Result<Bound<'py, PyDict>> {
    let radix = radix_of(radix)?;
    let terms = Terms { threads: Some(1), progress: None };
    let read = running::run(py, terms, move |watch| {
        let mut opened = open(&path, radix, Some(&watch.stop))?;
        let columns = opened.columns;
        let mut read = Read {
            form: opened.form,
            values: vec![Vec::new(); columns.len()],
            unknown: vec![Vec::new(); columns.len()],
            columns,
            notes: opened.notes,
            samples: 0,
            windows: Vec::new(),
            triggers: Vec::new(),
            gaps: Vec::new(),
        };
        let mut row = CaptureRow::default();
        while opened.rows.next(&mut row)? {
            if read.samples.is_multiple_of(BETWEEN) {
                poll_stop(Some(&watch.stop))?;
            }
            read.take(&row);
        }
        Ok(read)
    })?;
    read.into_dict(py)
}

impl Read {
    fn take(&mut self, row: &CaptureRow) {
        let place = self.samples as u64;
        for (k, column) in self.columns.iter().enumerate() {
            self.values[k].extend_from_slice(&row.value[column.place()]);
            self.unknown[k].extend_from_slice(&row.unknown[column.place()]);
        }
        let marks = [
            (row.window_start, &mut self.windows),
            (row.trigger, &mut self.triggers),
            (row.gap, &mut self.gaps),
        ];
        marks.into_iter().filter(|(is_set, _)| *is_set).for_each(|(_, list)| list.push(place));
        self.samples += 1;
    }

    fn into_dict(self, py: Python<'_>) -> Result<Bound<'_, PyDict>> {
        let (signals, unknown) = (PyDict::new(py), PyDict::new(py));
        let (widths, lists) = (PyDict::new(py), self.values.into_iter().zip(self.unknown));
        for (column, (values, unknowns)) in self.columns.iter().zip(lists) {
            let name = column.head();
            widths.set_item(&name, column.width)?;
            if column.text {
                let words: Vec<_> = values.chunks_exact(column.words()).map(word).collect();
                signals.set_item(&name, words)?;
                continue;
            }
            for (found, words) in [(&signals, values), (&unknown, unknowns)] {
                match column.words() {
                    1 => found.set_item(&name, PyArray1::from_vec(py, words))?,
                    several => found.set_item(&name, table(py, words, several)?)?,
                }
            }
        }
        let form = match self.form {
            CaptureForm::Csv => "csv",
            CaptureForm::LegacyCsv => "csv without radices",
            CaptureForm::Archive => "ila",
        };
        let found = PyDict::new(py);
        found.set_item("form", form)?;
        found.set_item("samples", self.samples)?;
        found.set_item("signals", signals)?;
        found.set_item("unknown", unknown)?;
        found.set_item("widths", widths)?;
        for (name, places) in
            [("windows", self.windows), ("triggers", self.triggers), ("gaps", self.gaps)]
        {
            found.set_item(name, PyArray1::from_vec(py, places))?;
        }
        found.set_item("notes", self.notes)?;
        Ok(found)
    }
}

/// The word that a value of a column of text is.
pub fn word(value: &[u64]) -> String {
    let bytes: Vec<u8> = value.iter().flat_map(|word| word.to_le_bytes()).collect();
    let text = bytes.split(|&byte| byte == 0).next().unwrap_or_default();
    String::from_utf8_lossy(text).into_owned()
}
