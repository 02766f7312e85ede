//! Histograms of many scenes, which are drawn anywhere, some at a time.

use std::ops::Range;
use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use serde_json::json;

use tofsim::error::{Input, poll_stop};
use tofsim_cli::verbs::scenes::Scenes;
use tofsim_learn::dataset::grid::MOST_ROWS;
use tofsim_learn::dataset::{BLOCK, Grid, GridPurpose, Rows, Sample, Subset};

use crate::arrays::table;
use crate::errors::Result;
use crate::objects::object;
use crate::running::{self, Terms};
use crate::scenario::Scenario;

/// Which scenes, and what draws their histograms: the rows of `tofsim dataset` with the same options. It travels as the
/// text of its scenario.
#[pyclass(module = "tofsim._tofsim", frozen)]
pub struct Dataset {
    scenario: Scenario,
    /// `--grid`, `--rows`, `--repeats` and `--seed`, as they were given.
    options: (Vec<String>, Option<u64>, u64, Option<u64>),
    pub(crate) drawn: Arc<Drawn>,
}

/// A dataset to draw.
pub struct Drawn {
    pub scenes: Scenes,
    pub rows: Rows,
    pub seed: u64,
}

impl Dataset {
    /// The command that draws the same, but for the formats of its files.
    pub fn command(&self) -> Vec<String> {
        let (grid, rows, repeats, seed) = &self.options;
        let set = self.scenario.loaded.set.iter().map(|set| format!("--set={set}"));
        let rows = rows.map(|rows| format!("--rows={rows}"));
        let seed = seed.map(|seed| format!("--seed={seed}"));
        let grid = grid.iter().map(|grid| format!("--grid={grid}"));
        let repeats = (*repeats != 5).then(|| format!("--repeats={repeats}"));
        let options = set.chain(rows).chain(seed).chain(grid).chain(repeats);
        ["dataset".to_owned()].into_iter().chain(options).chain([self.scenario.word()]).collect()
    }

    /// Draws neighbouring rows, on so many threads.
    fn samples(
        &self,
        py: Python<'_>,
        range: Range<u64>,
        threads: Option<usize>,
    ) -> Result<Vec<Sample>> {
        let count = self.drawn.rows.count();
        if range.end > count || range.start > range.end {
            let value = format!("{range:?}");
            return Err(Input::new("rows", format!("expected rows of {count}"))
                .value(value)
                .into());
        }
        // The task may be left to itself.
        let drawn = Arc::clone(&self.drawn);
        running::run(py, Terms { threads, progress: None }, move |watch| {
            let mut samples = Vec::new();
            for from in range.clone().step_by(BLOCK as usize) {
                poll_stop(Some(&watch.stop))?;
                let block = from..range.end.min(from + BLOCK);
                samples.extend(drawn.scenes.source.block(&drawn.rows, drawn.seed, block));
            }
            Ok(samples)
        })
    }

    fn counts_of<'py>(
        &self,
        py: Python<'py>,
        samples: &[Sample],
    ) -> Result<Bound<'py, PyArray2<u32>>> {
        let counts = samples.iter().flat_map(|sample| sample.histogram.iter().copied()).collect();
        Ok(table(py, counts, self.drawn.scenes.source.size().bins)?)
    }
}

#[pymethods]
impl Dataset {
    #[new]
    #[pyo3(signature = (scenario = None, grid = Vec::new(), rows = None, repeats = 5, seed = None))]
    fn new(
        scenario: Option<&Bound<'_, PyAny>>,
        grid: Vec<String>,
        rows: Option<u64>,
        repeats: u64,
        seed: Option<u64>,
    ) -> Result<Self> {
        for (name, given) in [("repeats", repeats), ("rows", rows.unwrap_or(1))] {
            if !(1..=MOST_ROWS).contains(&given) {
                let expected = format!("expected 1 to {MOST_ROWS}");
                return Err(Input::new(name, expected).value(given).into());
            }
        }
        let scenario = Scenario::of(scenario)?;
        let load = |set: &[String]| {
            let mut loaded = scenario.with_set(set)?;
            loaded.scenario.seed = seed.unwrap_or(loaded.scenario.seed);
            Ok(loaded)
        };
        let scenes = Scenes::new(&grid, &scenario.loaded.set, GridPurpose::Training, load)?;
        let first_seed = scenes.loaded[0].scenario.seed;
        let all = Grid { repeats, ..scenes.grid.clone() };
        let drawn_rows = match rows {
            None => Rows::All(all.clone().repeated(repeats)?),
            Some(rows) => Rows::Subset(Subset::new(all, rows, first_seed)),
        };
        let drawn = Arc::new(Drawn { scenes, rows: drawn_rows, seed: first_seed });
        Ok(Dataset { scenario, options: (grid, rows, repeats, seed), drawn })
    }

    /// Histograms in all.
    #[getter]
    fn rows(&self) -> u64 {
        self.drawn.rows.count()
    }

    /// Returns notes on scenes that cannot have a depth.
    fn notes<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(object(py, &json!(self.drawn.scenes.notes()?))?)
    }

    /// The same, a sentence each.
    fn sentences(&self) -> Result<Vec<String>> {
        Ok(self.drawn.scenes.notes()?.iter().map(ToString::to_string).collect())
    }

    /// The histograms of the rows from `begin` to before `end`.
    #[pyo3(signature = (begin, end, threads = None))]
    fn counts<'py>(
        &self,
        py: Python<'py>,
        begin: u64,
        end: u64,
        threads: Option<usize>,
    ) -> Result<Bound<'py, PyArray2<u32>>> {
        self.counts_of(py, &self.samples(py, begin..end, threads)?)
    }

    /// The same rows as a dictionary of arrays: histograms, row numbers, and what varies from row to row.
    #[pyo3(signature = (begin, end, threads = None))]
    fn batch<'py>(
        &self,
        py: Python<'py>,
        begin: u64,
        end: u64,
        threads: Option<usize>,
    ) -> Result<Bound<'py, PyDict>> {
        let samples = self.samples(py, begin..end, threads)?;
        let found = PyDict::new(py);
        found.set_item("histograms", self.counts_of(py, &samples)?)?;
        let rows = samples.iter().map(|sample| sample.row).collect();
        found.set_item("row", PyArray1::<u64>::from_vec(py, rows))?;
        let grid = self.drawn.rows.grid();
        let values: Vec<_> = samples.iter().map(|sample| grid.values(&sample.scene)).collect();
        for (place, column) in grid.columns().into_iter().enumerate() {
            let name = column.key.unwrap_or(column.name);
            let numbers = values.iter().map(|of_row| of_row[place]);
            if column.is_index {
                let indices = numbers.map(|index| index as u64).collect();
                found.set_item(name, PyArray1::<u64>::from_vec(py, indices))?;
            } else {
                found.set_item(name, PyArray1::<f64>::from_vec(py, numbers.collect()))?;
            }
        }
        Ok(found)
    }

    fn __repr__(&self) -> String {
        let name = &self.scenario.loaded.name;
        format!("<tofsim.Dataset {name}: {} histograms>", self.drawn.rows.count())
    }

    /// Travels as its scenario and options.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> Result<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let Dataset { scenario, options: (grid, rows, repeats, seed), .. } = slf.get();
        let scenario = Bound::new(slf.py(), scenario.clone())?;
        let parts = (scenario, grid, rows, repeats, seed).into_pyobject(slf.py())?;
        Ok((slf.get_type().into_any(), parts))
    }
}
