//! `tofsim.waves`: waveforms as arrays of changes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use tofsim::error::{Input, poll_stop};
use tofsim_captures::source::{Axis, Signal, SignalKind, Source};

use crate::arrays::table;
use crate::errors::Result;
use crate::ila::word;
use crate::running::{self, Terms};

/// Names of the signals of a waveform, or of any other file that can be compared, with their widths.
#[pyfunction]
#[pyo3(name = "_wave_signals")]
pub fn wave_signals(py: Python<'_>, path: PathBuf) -> Result<BTreeMap<String, u32>> {
    let terms = Terms { threads: Some(1), progress: None };
    running::run(py, terms, move |watch| {
        let source = Source::file_stopped_by(&path, None, Arc::clone(&watch.stop))?;
        let readable = source.signals.into_iter().filter(|one| one.kind != SignalKind::Event);
        Ok(readable.map(|signal| (signal.name.text, signal.width)).collect())
    })
}

/// Changes of a signal.
#[derive(Default)]
struct Changes {
    at: Vec<u64>,
    values: Vec<u64>,
    unknown: Vec<u64>,
}

/// Contents of a file.
struct Read {
    format: &'static str,
    axis: Axis,
    end: Option<u64>,
    signals: Vec<Signal>,
    changes: Vec<Changes>,
    notes: Vec<String>,
}

/// Reads the changes of some signals; the parts of a `tofsim.waves.Waves` as a dictionary.
#[pyfunction]
#[pyo3(name = "_read_waves")]
pub fn read_waves(py: Python<'_>, path: PathBuf, names: Vec<String>) -> Result<Bound<'_, PyDict>> {
    let terms = Terms { threads: Some(1), progress: None };
    let read = running::run(py, terms, move |watch| {
        let source = Source::file_stopped_by(&path, None, Arc::clone(&watch.stop))?;
        let signal = |name: &String| {
            let found = source.signals.iter().find(|signal| signal.name.text == *name);
            let fault = || Input::new(path.display(), "there is no such signal").value(name);
            found.cloned().ok_or_else(fault)
        };
        let signals = names.iter().map(signal).collect::<std::result::Result<Vec<_>, _>>()?;
        let ids: Vec<_> = signals.iter().map(|signal| signal.id).collect();
        let mut changes: Vec<Changes> = ids.iter().map(|_| Changes::default()).collect();
        let mut cursor = source.read(&ids)?;
        let mut touched = Vec::new();
        while let Some(at) = cursor.peek()? {
            poll_stop(Some(&watch.stop))?;
            touched.clear();
            cursor.take(|signal| touched.push(signal));
            for &signal in &touched {
                let changes = &mut changes[signal];
                changes.at.push(at);
                changes.values.extend_from_slice(cursor.state.value(signal));
                changes.unknown.extend_from_slice(cursor.state.unknown(signal));
            }
        }
        let (format, axis, end) = (source.format.into(), source.axis, source.end);
        Ok(Read { format, axis, end, signals, changes, notes: source.notes })
    })?;
    read.into_dict(py)
}

impl Read {
    fn into_dict(self, py: Python<'_>) -> Result<Bound<'_, PyDict>> {
        let axis = self.axis;
        // No file goes on for the 2.5 hours that do not fit.
        let place = |at: u64| axis.femtoseconds(at).map_or(at as i64, |fs| fs as i64);
        let signals = PyDict::new(py);
        for (signal, changes) in self.signals.iter().zip(self.changes) {
            let found = PyDict::new(py);
            let at = changes.at.iter().map(|&at| place(at)).collect();
            found.set_item("at", PyArray1::<i64>::from_vec(py, at))?;
            found.set_item("width", signal.width)?;
            let words = signal.width.div_ceil(64).max(1) as usize;
            match signal.kind {
                SignalKind::Real => {
                    let reals = changes.values.iter().map(|bits| f64::from_bits(*bits)).collect();
                    found.set_item("values", PyArray1::<f64>::from_vec(py, reals))?;
                }
                SignalKind::Text => {
                    let texts: Vec<_> = changes.values.chunks_exact(words).map(word).collect();
                    found.set_item("values", texts)?;
                }
                _ => {
                    for (key, list) in [("values", changes.values), ("unknown", changes.unknown)] {
                        match words {
                            1 => found.set_item(key, PyArray1::from_vec(py, list))?,
                            _ => found.set_item(key, table(py, list, words)?)?,
                        }
                    }
                }
            }
            signals.set_item(&signal.name.text, found)?;
        }
        let found = PyDict::new(py);
        found.set_item("format", self.format)?;
        found.set_item("is_in_samples", axis == Axis::Samples)?;
        found.set_item("end", self.end.map(place))?;
        found.set_item("signals", signals)?;
        found.set_item("notes", self.notes)?;
        Ok(found)
    }
}
