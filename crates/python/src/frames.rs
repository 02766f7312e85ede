//! Frames of a run, column by column.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;

use tofsim::error::Input;
use tofsim::firmware::tof_top::slot::EstimateWords;
use tofsim::sim::estimates::{EchoDepth, Estimate};
use tofsim::{Note, Setup};
use tofsim_cli::report::causes::{CAUSES, Causes};

use crate::arrays::table;
use crate::errors::Result;
use crate::frame::Frame;
use crate::objects::object;

/// Frames as they come.
pub struct Columns {
    histograms: Vec<u32>,
    words: Vec<EstimateWords>,
    /// Number, shots, hits, hits of the TDC, cycles of the estimator and of the frame.
    numbers: [Vec<u64>; 6],
    laser_en: Vec<bool>,
    /// Hits of each frame by their causes, if these are counted.
    pub causes: Option<Vec<Causes>>,
    /// Notes on the depths.
    pub notes: Vec<Note>,
}

impl Columns {
    /// None yet, of so many frames.
    ///
    /// # Errors
    /// When the memory does not hold them.
    pub fn new(setup: &Setup, count: u64, is_by_cause: bool) -> tofsim::Result<Self> {
        let (bins, count) = (setup.params.histogram.bins, count as usize);
        let columns = if is_by_cause { 1 + CAUSES.len() } else { 1 };
        let words = bins.saturating_mul(columns).saturating_mul(count);
        let mut histograms = Vec::new();
        if histograms.try_reserve_exact(words).is_err() {
            let expected = format!("expected fewer: the memory does not hold {words} counts");
            return Err(Input::new("frames", expected).value(count).into());
        }
        // Causes have vectors of their own.
        histograms.shrink_to(bins * count);
        let none = || -> Causes { std::array::from_fn(|_| vec![0; bins]) };
        Ok(Columns {
            histograms,
            words: Vec::new(),
            numbers: Default::default(),
            laser_en: Vec::new(),
            causes: is_by_cause.then(|| (0..count).map(|_| none()).collect()),
            notes: Vec::new(),
        })
    }

    /// Takes the next frame.
    pub fn push(&mut self, frame: &tofsim::Frame) {
        self.histograms.extend_from_slice(&frame.histogram);
        self.words.push(frame.words);
        let hits = frame.hits();
        let tofsim::Frame { index, shots, tdc_hits, estimator_cycles, frame_cycles, .. } = *frame;
        let numbers = [index, shots, hits, tdc_hits, estimator_cycles, frame_cycles];
        self.numbers.iter_mut().zip(numbers).for_each(|(column, number)| column.push(number));
        self.laser_en.push(frame.laser_en);
    }
}

/// Frames of a run: an array for each quantity, with a value or a row for each frame.
#[pyclass(module = "tofsim", frozen)]
pub struct Frames {
    setup: Arc<Setup>,
    columns: Columns,
    /// Counts of each bin, a row for each frame, `uint32` [hits].
    #[pyo3(get)]
    histograms: Py<PyArray2<u32>>,
    /// Depth [m].
    #[pyo3(get)]
    depth_m: Py<PyArray1<f64>>,
    /// The estimator's word.
    #[pyo3(get)]
    depth_raw: Py<PyArray1<i64>>,
    /// Name of the estimator.
    #[pyo3(get)]
    estimator: &'static str,
    /// Standard deviation of the depth, NaN from an estimator that states none [m].
    #[pyo3(get)]
    sigma_m: Py<PyArray1<f64>>,
    /// Whether the status has no reason to reject the depth.
    #[pyo3(get)]
    valid: Py<PyArray1<bool>>,
    /// Reasons to reject the depth, a list of words for each frame.
    #[pyo3(get)]
    status: Vec<Vec<&'static str>>,
    /// What a host can rely on, a word for each frame; `not stated` from an estimator without a status.
    #[pyo3(get)]
    status_code: Vec<&'static str>,
    /// Depth of the second target, NaN where the firmware has found none [m].
    #[pyo3(get)]
    second_depth_m: Py<PyArray1<f64>>,
    /// Standard deviation of that depth, NaN likewise [m].
    #[pyo3(get)]
    second_sigma_m: Py<PyArray1<f64>>,
    /// Whether there is a second target whose status has no reason to reject its depth.
    #[pyo3(get)]
    second_valid: Py<PyArray1<bool>>,
    /// Number of the frame, from 0.
    #[pyo3(get)]
    index: Numbers,
    /// Shots counted.
    #[pyo3(get)]
    shots: Numbers,
    /// Hits in the histogram.
    #[pyo3(get)]
    hits: Numbers,
    /// Hits that the TDC kept, with a code or without.
    #[pyo3(get)]
    tdc_hits: Numbers,
    /// From the edge that takes `algo_start` to the one that raises `algo_done` [cycles of `clk_sys`].
    #[pyo3(get)]
    estimator_cycles: Numbers,
    /// From the edge that begins Clear to the one that raises `algo_done` [cycles of `clk_sys`].
    #[pyo3(get)]
    frame_cycles: Numbers,
    /// Whether the laser could fire, as the frame ended.
    #[pyo3(get)]
    laser_en: Py<PyArray1<bool>>,
}

type Numbers = Py<PyArray1<u64>>;

impl Frames {
    /// The frames as arrays.
    pub fn new(py: Python<'_>, setup: Arc<Setup>, mut columns: Columns) -> Result<Self> {
        let bins = setup.params.histogram.bins;
        let histograms = std::mem::take(&mut columns.histograms);
        let estimator = setup.params.estimator;
        let estimates = columns.words.iter().map(|words| Estimate::of_words(estimator, words));
        let estimates: Vec<_> = estimates.collect();
        let metres = columns.words.iter().map(|words| words.depth.to_f64()).collect();
        let words = columns.words.iter().map(|words| words.depth.get()).collect();
        let sigmas = estimates.iter().map(|one| one.sigma_m.unwrap_or(f64::NAN)).collect();
        let valid = estimates.iter().map(|one| one.valid).collect();
        let status = estimates.iter().map(|one| one.status.words()).collect();
        let status_code = estimates.iter().map(|one| one.status_code.word()).collect();
        let seconds = |of: fn(&EchoDepth) -> f64| {
            let metres = estimates.iter().map(|one| one.second.as_ref().map_or(f64::NAN, of));
            PyArray1::from_vec(py, metres.collect()).unbind()
        };
        let is_valid = |one: &Estimate| one.second.and_then(|second| second.valid).unwrap_or(false);
        let second_valid = estimates.iter().map(is_valid).collect();
        let numbers = std::mem::take(&mut columns.numbers);
        let [index, shots, hits, tdc_hits, estimator_cycles, frame_cycles] =
            numbers.map(|column| PyArray1::from_vec(py, column).unbind());
        let laser_en = std::mem::take(&mut columns.laser_en);
        Ok(Frames {
            histograms: table(py, histograms, bins)?.unbind(),
            depth_m: PyArray1::from_vec(py, metres).unbind(),
            depth_raw: PyArray1::from_vec(py, words).unbind(),
            estimator: estimator.estimator(),
            sigma_m: PyArray1::from_vec(py, sigmas).unbind(),
            valid: PyArray1::from_vec(py, valid).unbind(),
            status,
            status_code,
            second_depth_m: seconds(|second| second.depth_m),
            second_sigma_m: seconds(|second| second.sigma_m),
            second_valid: PyArray1::from_vec(py, second_valid).unbind(),
            index,
            shots,
            hits,
            tdc_hits,
            estimator_cycles,
            frame_cycles,
            laser_en: PyArray1::from_vec(py, laser_en).unbind(),
            setup,
            columns,
        })
    }
}

#[pymethods]
impl Frames {
    /// Name of the scenario.
    #[getter]
    fn scenario(&self) -> &str {
        &self.setup.name
    }

    /// Distance of the target, if light of it can be seen [m].
    #[getter]
    fn true_depth_m(&self) -> Option<f64> {
        self.setup.true_depth_m()
    }

    /// Distance of the second target, if the firmware looks for one and light of it can be seen [m].
    #[getter]
    fn second_true_depth_m(&self) -> Option<f64> {
        self.setup.true_depths()?.second_m
    }

    /// The notes on the depths, each a dictionary.
    #[getter]
    fn notes<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(object(py, &json!(self.columns.notes))?)
    }

    /// Hits of each bin by what set them off: a table like `histograms` for each cause, or none without `by_cause`.
    #[getter]
    fn by_cause<'py>(&self, py: Python<'py>) -> Result<Option<Bound<'py, PyDict>>> {
        let Some(frames) = &self.columns.causes else { return Ok(None) };
        let bins = self.setup.params.histogram.bins;
        let found = PyDict::new(py);
        for (place, (_, name, _)) in CAUSES.iter().enumerate() {
            let counts = frames.iter().flat_map(|frame| frame[place].iter().copied()).collect();
            let counts: Bound<'py, PyArray2<u32>> = table(py, counts, bins)?;
            found.set_item(if *name == "hits" { "unknown" } else { name }, counts)?;
        }
        Ok(Some(found))
    }

    fn __len__(&self) -> usize {
        self.columns.words.len()
    }

    fn __getitem__(&self, py: Python<'_>, place: isize) -> Result<Frame> {
        let count = self.__len__();
        let found = if place < 0 { place.checked_add_unsigned(count) } else { Some(place) };
        let found = found.and_then(|place| usize::try_from(place).ok()).filter(|&k| k < count);
        let Some(place) = found else {
            let text = format!("frame {place} of {count}");
            return Err(PyIndexError::new_err(text).into());
        };
        let histograms = self.histograms.bind(py).as_any();
        let counts: Vec<u32> = histograms.get_item(place)?.call_method0("tolist")?.extract()?;
        let number = |of: &Numbers| of.bind(py).as_any().get_item(place)?.extract::<u64>();
        Ok(Frame {
            setup: Arc::clone(&self.setup),
            index: number(&self.index)?,
            depth: self.columns.words[place].depth,
            estimate: Estimate::of_words(self.setup.params.estimator, &self.columns.words[place]),
            hits: number(&self.hits)?,
            tdc_hits: number(&self.tdc_hits)?,
            shots: number(&self.shots)?,
            estimator_cycles: number(&self.estimator_cycles)?,
            frame_cycles: number(&self.frame_cycles)?,
            causes: self.columns.causes.as_ref().map(|frames| frames[place].clone()),
            counts,
        })
    }

    fn __iter__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let builtins = slf.py().import("builtins")?;
        let places = builtins.getattr("range")?.call1((slf.len()?,))?;
        builtins.getattr("map")?.call1((slf.getattr("__getitem__")?, places))
    }

    fn __repr__(&self) -> String {
        format!("<tofsim.Frames {} of {}>", self.__len__(), self.setup.name)
    }
}
