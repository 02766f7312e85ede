//! `tofsim.dataset`: histograms of many scenes, some at a time.

use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use tofsim::error::{Error, Input};
use tofsim_cli::verbs::scenes::Scenes;
use tofsim_learn::dataset::grid::{DISTANCE, IRRADIANCE, MOST_ROWS, REFLECTANCE};
use tofsim_learn::dataset::{BLOCK, Grid, GridPurpose, Rows, Sample, Subset};

use crate::arrays::table;
use crate::errors::Result;
use crate::running::{self, Terms};
use crate::scenario::Scenario;

/// Batches of drawn histograms, each a dictionary of arrays.
#[pyclass(module = "tofsim", frozen)]
pub struct Batches {
    drawn: Arc<Drawn>,
    batch: u64,
    threads: Option<usize>,
    next: Mutex<u64>,
}

/// What is drawn.
struct Drawn {
    scenes: Scenes,
    rows: Rows,
    seed: u64,
}

#[pymethods]
impl Batches {
    #[new]
    #[pyo3(signature = (scenario, grid, rows, repeats, batch, seed, threads))]
    fn new(
        scenario: Option<&Bound<'_, PyAny>>,
        grid: Vec<String>,
        rows: Option<u64>,
        repeats: u64,
        batch: u64,
        seed: Option<u64>,
        threads: Option<usize>,
    ) -> Result<Self> {
        for (name, given) in [("batch", batch), ("repeats", repeats), ("rows", rows.unwrap_or(1))] {
            if !(1..=MOST_ROWS).contains(&given) {
                let expected = format!("expected 1 to {MOST_ROWS}");
                return Err(Input::new(name, expected).value(given).into());
            }
        }
        let scenario = Scenario::of(scenario)?;
        let seed = seed.unwrap_or(scenario.loaded.scenario.seed);
        let load = |set: &[String]| scenario.with_set(set);
        let set = &scenario.loaded.set;
        let scenes = Scenes::new(&grid, set, GridPurpose::Training, load)?;
        let grid = Grid { repeats, ..scenes.grid.clone() };
        let rows = match rows {
            None => Rows::All(grid.clone().repeated(repeats)?),
            Some(rows) => Rows::Subset(Subset::new(grid, rows, seed)),
        };
        let drawn = Arc::new(Drawn { scenes, rows, seed });
        Ok(Batches { drawn, batch, threads, next: Mutex::new(0) })
    }

    /// Histograms in all.
    #[getter]
    fn rows(&self) -> u64 {
        self.drawn.rows.count()
    }

    fn __len__(&self) -> usize {
        self.drawn.rows.count().div_ceil(self.batch) as usize
    }

    fn __iter__(batches: PyRef<'_, Self>) -> PyRef<'_, Self> {
        batches
    }

    fn __next__<'py>(&self, py: Python<'py>) -> Result<Option<Bound<'py, PyDict>>> {
        let begin = {
            let mut next = self.next.lock().unwrap_or_else(PoisonError::into_inner);
            let after = next.saturating_add(self.batch);
            std::mem::replace(&mut *next, after)
        };
        let end = self.drawn.rows.count().min(begin.saturating_add(self.batch));
        if begin >= end {
            return Ok(None);
        }
        let drawn = Arc::clone(&self.drawn);
        let terms = Terms { threads: self.threads, progress: None };
        let samples = running::run(py, terms, move |watch| {
            let mut samples = Vec::new();
            for from in (begin..end).step_by(BLOCK as usize) {
                if watch.stop.load(Ordering::Relaxed) {
                    return Err(Error::Interrupted);
                }
                let block = from..end.min(from + BLOCK);
                samples.extend(drawn.scenes.source.block(&drawn.rows, drawn.seed, block));
            }
            Ok(samples)
        })?;
        self.batch_of(py, &samples).map(Some)
    }
}

impl Batches {
    fn batch_of<'py>(&self, py: Python<'py>, samples: &[Sample]) -> Result<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        let bins = self.drawn.scenes.source.size().bins;
        let counts = samples.iter().flat_map(|sample| sample.histogram.iter().copied()).collect();
        let counts: Bound<'py, PyArray2<u32>> = table(py, counts, bins)?;
        found.set_item("histograms", counts)?;
        let rows = samples.iter().map(|sample| sample.row).collect();
        found.set_item("row", PyArray1::<u64>::from_vec(py, rows))?;
        let column = |of: &dyn Fn(&Sample) -> f64| {
            PyArray1::<f64>::from_vec(py, samples.iter().map(of).collect())
        };
        found.set_item(DISTANCE, column(&|sample| sample.scene.distance_m))?;
        found.set_item(REFLECTANCE, column(&|sample| sample.scene.reflectance))?;
        found.set_item(IRRADIANCE, column(&|sample| sample.scene.irradiance_w_m2_nm))?;
        let grid = self.drawn.rows.grid();
        for (place, axis) in grid.others.iter().enumerate() {
            let value = |sample: &Sample| grid.setting(sample.scene.setting)[place].1;
            found.set_item(&axis.key, column(&value))?;
        }
        Ok(found)
    }
}
