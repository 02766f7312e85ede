//! `tofsim.image`: depth images of an array of pixels, as arrays.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::json;

use tofsim::error::Input;
use tofsim::note::merged;
use tofsim::sim::setup::array::ArraySetup;
use tofsim_cli::report::image::{ArrayValues, DepthImages, ImagePixel};
use tofsim_cli::report::writer::Findings;
use tofsim_cli::verbs::frames::check;
use tofsim_learn::estimation::notes::notes_of_firmware;

use crate::errors::Result;
use crate::objects::object;
use crate::running::{self, Terms};
use crate::scenario::Scenario;
use crate::simulate::fidelity_of;

/// Scenario unless another one is given.
const DEFAULT: &str = "array";

/// Simulates depth images of an array of pixels.
///
/// `progress` is called with how many pixels of how many are done.
#[pyfunction]
#[pyo3(signature = (scenario = None, images = 1, fidelity = "shot", seed = None, threads = None, *, progress = None))]
pub fn image<'py>(
    py: Python<'py>,
    scenario: Option<&Bound<'py, PyAny>>,
    images: u64,
    fidelity: &str,
    seed: Option<u64>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> Result<Bound<'py, PyDict>> {
    let fidelity = fidelity_of(fidelity)?;
    if images == 0 {
        return Err(Input::new("images", "expected 1 at least").value(0).into());
    }
    let loaded = match scenario {
        None => Scenario::load(DEFAULT, &[])?.seeded(seed),
        given => Scenario::of(given)?.seeded(seed),
    };
    let (array, pixels) = running::run(py, Terms { threads, progress }, move |watch| {
        let array = ArraySetup::new(loaded)?;
        check("images", images, array.common())?;
        let count = array.size().into_iter().product::<usize>() as u64;
        let done = |_| watch.add(count);
        let pixels = array.images(fidelity.of_images(), images, Some(&watch.stop), &done)?;
        Ok((array, pixels))
    })?;
    let mut notes = merged(pixels.iter().map(|pixel| &pixel.notes[..]));
    notes.extend(notes_of_firmware(array.common()));
    let pixels = ImagePixel::all(&array, pixels);
    let all = DepthImages { array: &array, fidelity: fidelity.name(), images, waves: None, pixels };
    let found = PyDict::new(py);
    for array in all.arrays() {
        let shape = array.shape;
        let values = match array.values {
            ArrayValues::Floats(all) => PyArray1::from_vec(py, all).reshape(shape)?.into_any(),
            ArrayValues::Bools(all) => PyArray1::from_vec(py, all).reshape(shape)?.into_any(),
            ArrayValues::Words(all) => PyArray1::from_vec(py, all).reshape(shape)?.into_any(),
            ArrayValues::Counts(all) => PyArray1::from_vec(py, all).reshape(shape)?.into_any(),
        };
        found.set_item(array.name, values)?;
    }
    let mut info = all.object();
    info["notes"] = json!(notes);
    found.set_item("info", object(py, &info)?)?;
    Ok(found)
}
