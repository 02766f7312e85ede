//! Arrays that Python owns, and histograms that it lends.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use tofsim::error::Input;
use tofsim::firmware::histogram_builder::Params;

use crate::errors::Result;

/// Rows of equal length as a table; without rows it has `columns`.
pub fn table<'py, T: numpy::Element>(
    py: Python<'py>,
    values: Vec<T>,
    columns: usize,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let rows = values.len() / columns.max(1);
    PyArray1::from_vec(py, values).reshape([rows, columns])
}

/// Histograms that are lent: one, or a row each.
pub struct Lent<'py> {
    array: PyReadonlyArrayDyn<'py, u32>,
    bins: usize,
}

impl<'py> Lent<'py> {
    /// An array of whole numbers, of `uint32` without a copy and else with one.
    ///
    /// # Errors
    /// When it is none, or has another number of bins, or a count that does not fit.
    pub fn new(given: &Bound<'py, PyAny>, size: &Params) -> Result<Self> {
        let py = given.py();
        let numpy = py.import("numpy")?;
        let array = numpy.call_method1("asarray", (given,))?;
        let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
        if !matches!(kind.as_str(), "u" | "i") {
            let dtype = array.getattr("dtype")?.str()?.to_string();
            let expected = "expected whole numbers, as numpy.uint32";
            return Err(Input::new("histograms", expected).field("dtype").value(dtype).into());
        }
        let most = size.most_hits();
        if array.getattr("size")?.extract::<usize>()? > 0 {
            let ends = (array.call_method0("min")?, array.call_method0("max")?);
            for end in [ends.0, ends.1] {
                let count: i128 = end.call_method0("item")?.extract()?;
                if !(0..=i128::from(most)).contains(&count) {
                    let expected = format!("expected counts from 0 to {most}");
                    return Err(Input::new("histograms", expected).value(count).into());
                }
            }
        }
        let wanted = numpy.call_method1("ascontiguousarray", (array, "uint32"))?;
        let array: PyReadonlyArrayDyn<'py, u32> = wanted.extract().map_err(PyErr::from)?;
        let shape = array.shape();
        if !matches!(shape, [bins] | [_, bins] if *bins == size.bins) {
            let expected = format!("expected n x {0} or {0} bins", size.bins);
            let value = format!("{shape:?}");
            return Err(Input::new("histograms", expected).field("shape").value(value).into());
        }
        Ok(Lent { array, bins: size.bins })
    }

    /// The histograms.
    ///
    /// # Errors
    /// When the array does not lie in one piece.
    pub fn rows(&self) -> Result<std::slice::ChunksExact<'_, u32>> {
        let all = self.array.as_slice();
        let all = all.map_err(|fault| Input::new("histograms", fault))?;
        Ok(all.chunks_exact(self.bins))
    }

    /// Returns whether there is a single histogram.
    pub fn is_single(&self) -> bool {
        self.array.shape().len() == 1
    }
}
