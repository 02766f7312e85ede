//! One frame.

use std::sync::Arc;

use numpy::PyArray1;
use pyo3::prelude::*;

use tofsim::Setup;
use tofsim::firmware::forward2::Depth;
use tofsim::sim::estimates::Estimate;
use tofsim_cli::report::causes::Causes;

use crate::errors::Result;
use crate::pictures;

/// One frame of a run.
#[pyclass(module = "tofsim", frozen)]
pub struct Frame {
    pub(crate) setup: Arc<Setup>,
    pub(crate) depth: Depth,
    pub(crate) estimate: Estimate,
    pub(crate) counts: Vec<u32>,
    pub(crate) causes: Option<Causes>,
    /// From 0.
    #[pyo3(get)]
    pub(crate) index: u64,
    /// Hits in the histogram.
    #[pyo3(get)]
    pub(crate) hits: u64,
    /// Hits that the TDC kept, with a code or without.
    #[pyo3(get)]
    pub(crate) tdc_hits: u64,
    /// Shots counted.
    #[pyo3(get)]
    pub(crate) shots: u64,
    /// From the edge that takes `algo_start` to the one that raises `algo_done` [cycles of `clk_sys`].
    #[pyo3(get)]
    pub(crate) estimator_cycles: u64,
    /// From the edge that begins Clear to the one that raises `algo_done` [cycles of `clk_sys`].
    #[pyo3(get)]
    pub(crate) frame_cycles: u64,
}

impl Frame {
    /// That a run of `setup` has finished.
    pub fn new(setup: Arc<Setup>, frame: &tofsim::Frame) -> Self {
        Frame {
            setup,
            depth: frame.words.depth,
            estimate: frame.estimate(),
            counts: frame.histogram.to_vec(),
            causes: None,
            index: frame.index,
            hits: frame.hits(),
            tdc_hits: frame.tdc_hits,
            shots: frame.shots,
            estimator_cycles: frame.estimator_cycles,
            frame_cycles: frame.frame_cycles,
        }
    }
}

#[pymethods]
impl Frame {
    /// Counts of each bin, `uint32` [hits].
    #[getter]
    fn histogram<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, &self.counts)
    }

    /// Depth [m].
    #[getter]
    fn depth_m(&self) -> f64 {
        self.depth.to_f64()
    }

    /// Name of the estimator.
    #[getter]
    fn estimator(&self) -> &'static str {
        self.estimate.estimator
    }

    /// Standard deviation of the depth, from an estimator that states one [m].
    #[getter]
    fn sigma_m(&self) -> Option<f64> {
        self.estimate.sigma_m
    }

    /// Whether the status has no reason to reject the depth.
    #[getter]
    fn valid(&self) -> bool {
        self.estimate.valid
    }

    /// Reasons to reject the depth, in words; empty if there are none.
    #[getter]
    fn status(&self) -> Vec<&'static str> {
        self.estimate.status.words()
    }

    /// What a host can rely on; `not stated` from an estimator without a status.
    #[getter]
    fn status_code(&self) -> &'static str {
        self.estimate.status_code.word()
    }

    /// Depth of the second target, if the firmware has found one [m].
    #[getter]
    fn second_depth_m(&self) -> Option<f64> {
        self.estimate.second.map(|second| second.depth_m)
    }

    /// Standard deviation of that depth [m].
    #[getter]
    fn second_sigma_m(&self) -> Option<f64> {
        self.estimate.second.map(|second| second.sigma_m)
    }

    /// Whether there is a second target whose status has no reason to reject its depth.
    #[getter]
    fn second_valid(&self) -> bool {
        self.estimate.second.and_then(|second| second.valid).unwrap_or(false)
    }

    /// The estimator's word.
    #[getter]
    fn depth_raw(&self) -> i64 {
        self.depth.get()
    }

    fn __repr__(&self) -> String {
        let (index, name, depth_m) = (self.index, &self.setup.name, self.depth.to_f64());
        format!("<tofsim.Frame {index} of {name}: {depth_m:.6} m, {} hits>", self.hits)
    }

    fn _repr_svg_(&self) -> Result<String> {
        let title = format!("{}, frame {}", self.setup.name, self.index);
        let counts = (&self.counts[..], self.causes.as_ref());
        pictures::histogram(&self.setup, &title, counts, Some(self.depth.to_f64()))
    }
}
