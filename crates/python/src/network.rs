//! A depth network, which travels as the text of its file.

use std::path::PathBuf;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use serde_json::json;

use tofsim::files::output::write_bytes;
use tofsim::firmware::histogram_builder::Params;
use tofsim::network::estimate;
use tofsim::network::file::Network as Trained;

use crate::arrays::{Lent, table};
use crate::errors::Result;
use crate::objects::object;

/// A depth network in the firmware's words, with what its file says of it.
#[pyclass(module = "tofsim", frozen)]
pub struct Network {
    pub(crate) network: Trained,
}

impl Network {
    fn size(&self) -> Params {
        Params { bins: self.network.fixed.bins(), ..Params::default() }
    }
}

#[pymethods]
impl Network {
    /// A network by its built-in name, or the path of its file.
    #[new]
    #[pyo3(signature = (name = None))]
    fn new(name: Option<PathBuf>) -> Result<Self> {
        let name = name.unwrap_or_else(|| Trained::DEFAULT.into());
        Ok(Network { network: Trained::find(&name.display().to_string(), None)? })
    }

    /// A network from the text of its file.
    #[staticmethod]
    #[pyo3(signature = (text, name = "network"))]
    fn from_toml(text: &str, name: &str) -> Result<Self> {
        Ok(Network { network: Trained::parse(text, name)? })
    }

    /// A network by its built-in name, or the path of its file.
    #[staticmethod]
    #[pyo3(signature = (name = None))]
    fn load(name: Option<PathBuf>) -> Result<Self> {
        Network::new(name)
    }

    /// Trains a network: `tofsim.train`.
    #[staticmethod]
    #[pyo3(signature = (*args, **options))]
    fn train<'py>(
        args: &Bound<'py, PyTuple>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        args.py().import("tofsim")?.getattr("train")?.call(args, options)
    }

    /// Rounds a network that was trained elsewhere: `tofsim.quantize`.
    #[staticmethod]
    #[pyo3(signature = (*args, **options))]
    fn quantize<'py>(
        args: &Bound<'py, PyTuple>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        args.py().import("tofsim")?.getattr("quantize")?.call(args, options)
    }

    /// The text of its file.
    fn to_toml(&self) -> String {
        self.network.to_toml()
    }

    /// Writes its file.
    fn save(&self, path: PathBuf) -> Result<()> {
        write_bytes(&path, self.network.to_toml())?;
        Ok(())
    }

    /// Built-in name, or the file's path.
    #[getter]
    fn name(&self) -> &str {
        &self.network.name
    }

    /// A description in a sentence.
    #[getter]
    fn description(&self) -> &str {
        &self.network.description
    }

    /// Hidden neurons.
    #[getter]
    fn neurons(&self) -> usize {
        self.network.fixed.neurons()
    }

    /// Inputs.
    #[getter]
    fn bins(&self) -> usize {
        self.network.fixed.bins()
    }

    /// How it came about.
    #[getter]
    fn training<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(object(py, &json!(self.network.training))?)
    }

    /// Errors measured, if any were.
    #[getter]
    fn accuracy<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(object(py, &json!(self.network.accuracy))?)
    }

    /// The weights as integers of the firmware's words: `w1` (neurons x bins), `b1`, `w2`, `b2`.
    #[getter]
    fn words<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>> {
        let fixed = &self.network.fixed;
        let found = PyDict::new(py);
        let w1: Bound<'py, PyArray2<i32>> = table(py, fixed.w1.concat(), fixed.bins())?;
        found.set_item("w1", w1)?;
        found.set_item("b1", PyArray1::from_vec(py, fixed.b1.clone()))?;
        found.set_item("w2", PyArray1::from_vec(py, fixed.w2.clone()))?;
        found.set_item("b2", fixed.b2)?;
        Ok(found)
    }

    /// The weights in double precision: those before rounding, or else the values of the words.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>> {
        let float = self.network.twin();
        let found = PyDict::new(py);
        let bins = float.bins();
        let w1: Bound<'py, PyArray2<f64>> = table(py, float.w1.concat(), bins)?;
        found.set_item("w1", w1)?;
        found.set_item("b1", PyArray1::from_vec(py, float.b1))?;
        found.set_item("w2", PyArray1::from_vec(py, float.w2))?;
        found.set_item("b2", float.b2)?;
        Ok(found)
    }

    /// Depths of histograms, one or n x bins, bit for bit as the firmware's: `depth_m` and `depth_raw`.
    fn estimate<'py>(
        &self,
        py: Python<'py>,
        histograms: &Bound<'py, PyAny>,
    ) -> Result<Bound<'py, PyDict>> {
        let size = self.size();
        let lent = Lent::new(histograms, &size)?;
        let params = self.network.params(&size);
        let rows = lent.rows()?;
        let depths: Vec<_> = rows.map(|row| estimate(&params, row).depth).collect();
        let found = PyDict::new(py);
        let metres: Vec<f64> = depths.iter().map(|depth| depth.to_f64()).collect();
        found.set_item("depth_m", PyArray1::from_vec(py, metres))?;
        let words: Vec<i64> = depths.iter().map(|depth| depth.get()).collect();
        found.set_item("depth_raw", PyArray1::from_vec(py, words))?;
        Ok(found)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let text = self.network.to_toml();
        other.cast::<Network>().is_ok_and(|other| other.get().network.to_toml() == text)
    }

    fn __repr__(&self) -> String {
        format!("<tofsim.Network {}: {}>", self.network.name, self.network.description)
    }

    /// Travels as text.
    fn __reduce__<'py>(&self, py: Python<'py>) -> Result<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let make = py.get_type::<Network>().getattr("from_toml")?;
        Ok((make, (self.network.to_toml(), &self.network.name).into_pyobject(py)?))
    }
}
