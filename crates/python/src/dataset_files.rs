//! The files of a data set whose histograms come from elsewhere.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use tofsim::error::Input;
use tofsim::files::folder::FolderLock;
use tofsim_cli::choice::DATASET_FORMAT;
use tofsim_learn::dataset::files::{DatasetFiles as Files, DatasetFormat};
use tofsim_learn::dataset::{DatasetDescription, Grid, Sample};

use crate::dataset::Dataset;
use crate::errors::Result;

/// The files of a data set in a folder, to which its rows come in order. They are put in place together, when all rows
/// are there.
#[pyclass(module = "tofsim._tofsim", frozen)]
pub struct DatasetFiles {
    dataset: Py<Dataset>,
    begun: Mutex<Option<Begun>>,
}

/// Files under construction.
struct Begun {
    files: Files,
    /// Rows that are in them.
    rows: u64,
    _held: FolderLock,
}

/// The format of that name.
fn format_of(name: &String) -> Result<DatasetFormat> {
    let found = DATASET_FORMAT.iter().find(|(word, ..)| word == name);
    let known: Vec<_> = DATASET_FORMAT.iter().map(|(word, ..)| *word).collect();
    let fault = || Input::new("formats", format!("expected some of {}", known.join(", ")));
    Ok(found.ok_or_else(|| fault().value(name))?.1)
}

#[pymethods]
impl DatasetFiles {
    #[new]
    fn new(dataset: Bound<'_, Dataset>, folder: PathBuf, formats: Vec<String>) -> Result<Self> {
        let (set, mut command) = (&dataset.get().drawn, dataset.get().command());
        if formats.is_empty() {
            return Err(Input::new("formats", "expected one at least: parquet, npy").into());
        }
        let wanted = formats.iter().map(format_of).collect::<Result<Vec<_>>>()?;
        if formats != ["parquet"] {
            let place = command.len() - 1;
            let words = formats.iter().map(|format| format!("--format={format}"));
            command.splice(place..place, words);
        }
        let (source, grid): (_, &Grid) = (&set.scenes.source, set.rows.grid());
        let setup = &set.scenes.setups[0];
        let about =
            DatasetDescription::new(setup, (&command, &wanted), source, &set.rows, set.seed);
        let held = FolderLock::take(&folder)?;
        let files = Files::create(&folder, &wanted, &about, grid)?;
        let begun = Mutex::new(Some(Begun { files, rows: 0, _held: held }));
        Ok(DatasetFiles { dataset: dataset.unbind(), begun })
    }

    /// Adds the histograms of the next rows.
    fn add(&self, counts: PyReadonlyArray2<'_, u32>) -> Result<()> {
        let set = &self.dataset.get().drawn;
        let mut begun = self.begun.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(begun) = begun.as_mut() else { return Ok(()) };
        let (bins, left) = (set.scenes.source.size().bins, set.rows.count() - begun.rows);
        let [rows, columns] = *counts.shape() else { return Ok(()) };
        if columns != bins || rows as u64 > left {
            let expected = format!("expected {left} x {bins} counts at most");
            let value = format!("{rows} x {columns}");
            return Err(Input::new("counts", expected).value(value).into());
        }
        let all = counts.as_slice().map_err(|fault| Input::new("counts", fault))?;
        let sample = |(index, counts): (u64, &[u32])| {
            let (row, scene) = set.rows.row(index);
            Sample { seed: set.seed, row, scene, histogram: counts.to_vec() }
        };
        let samples: Vec<_> = (begun.rows..).zip(all.chunks_exact(bins)).map(sample).collect();
        begun.files.write(&samples)?;
        begun.rows += rows as u64;
        Ok(())
    }

    /// Puts the files in place; their paths.
    fn finish(&self) -> Result<Vec<PathBuf>> {
        let begun = self.begun.lock().unwrap_or_else(PoisonError::into_inner).take();
        let rows = self.dataset.get().drawn.rows.count();
        match begun {
            Some(begun) if begun.rows == rows => Ok(begun.files.finish()?),
            begun => {
                let there = begun.map_or(0, |begun| begun.rows);
                Err(Input::new("rows", format!("expected all {rows}")).value(there).into())
            }
        }
    }

    /// Leaves nothing of files that are not in place.
    fn abandon(&self) {
        self.begun.lock().unwrap_or_else(PoisonError::into_inner).take();
    }
}
