//! Light that comes back, and depths of histograms of one's own.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;
use serde_json::{Value, json};

use tofsim::Setup;
use tofsim::error::Input;
use tofsim_cli::verbs::budget::findings::Findings;
use tofsim_learn::estimation::{EstimatorKind, Panel};
use tofsim_learn::quantize;

use crate::arrays::Lent;
use crate::errors::Result;
use crate::objects::object;
use crate::running::{self, Terms};
use crate::scenario::Scenario;

/// Photons and avalanches that a shot can expect, and eye safety: what `tofsim budget --json` prints, without a record.
#[pyfunction]
#[pyo3(signature = (scenario = None))]
pub fn link_budget<'py>(
    py: Python<'py>,
    scenario: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let findings = Findings::of(Setup::of_counts(Scenario::of(scenario)?.seeded(None))?);
    let mut found = findings.json();
    found["notes"] = json!(findings.notes()?);
    Ok(object(py, &found)?)
}

/// The estimators of those names.
fn kinds(names: &[String]) -> Result<Vec<EstimatorKind>> {
    let kind = |name: &String| {
        let found = EstimatorKind::ALL.iter().find(|(word, ..)| word == name);
        let known = || EstimatorKind::ALL.map(|(word, ..)| word).join(", ");
        let fault = || Input::new("estimators", format!("expected some of {}", known()));
        Ok(found.ok_or_else(|| fault().value(name))?.1)
    };
    names.iter().map(kind).collect()
}

/// Depths of histograms, one or n x bins, as a dictionary of arrays: `depth_m` and `depth_raw` of the firmware's own
/// estimator, bit for bit, and for each of `estimators` its depth, which is NaN where it fails [m].
#[pyfunction]
#[pyo3(signature = (histograms, scenario = None, *, estimators = Vec::new(), threads = None))]
pub fn estimate<'py>(
    py: Python<'py>,
    histograms: &Bound<'py, PyAny>,
    scenario: Option<&Bound<'py, PyAny>>,
    estimators: Vec<String>,
    threads: Option<usize>,
) -> Result<Bound<'py, PyDict>> {
    let setup = Setup::new(Scenario::of(scenario)?.seeded(None))?;
    let kinds = kinds(&estimators)?;
    let lent = Lent::new(histograms, &setup.params.histogram)?;
    // The task may be left to itself, and Python's memory not.
    let rows: Vec<Vec<u32>> = lent.rows()?.map(<[u32]>::to_vec).collect();
    let (depths, readings) = running::run(py, Terms { threads, progress: None }, move |watch| {
        let panel = Panel::new(&kinds, &setup)?;
        let estimators = panel.into_estimators();
        let one = |row: &Vec<u32>| {
            if watch.stop.load(std::sync::atomic::Ordering::Relaxed) {
                return Err(tofsim::Error::Interrupted);
            }
            let readings = estimators.iter().map(|one| one.estimate(row).unwrap_or(f64::NAN));
            Ok((setup.depth(row), readings.collect::<Vec<_>>()))
        };
        let found: Vec<_> = rows.par_iter().map(one).collect::<tofsim::Result<_>>()?;
        Ok(found.into_iter().unzip::<_, _, Vec<_>, Vec<_>>())
    })?;
    let found = PyDict::new(py);
    let metres = depths.iter().map(|depth| depth.to_f64()).collect();
    found.set_item("depth_m", PyArray1::<f64>::from_vec(py, metres))?;
    let words = depths.iter().map(|depth| depth.get()).collect();
    found.set_item("depth_raw", PyArray1::<i64>::from_vec(py, words))?;
    for (place, name) in estimators.iter().enumerate() {
        let metres = readings.iter().map(|each| each[place]).collect();
        found.set_item(name, PyArray1::<f64>::from_vec(py, metres))?;
    }
    Ok(found)
}

/// Where a depth comes from: every value of the network's datapath beside its twin in double precision, and what each
/// rounding adds. A dictionary for one histogram, and a list of them for several.
#[pyfunction]
#[pyo3(signature = (histograms, scenario = None))]
pub fn explain<'py>(
    py: Python<'py>,
    histograms: &Bound<'py, PyAny>,
    scenario: Option<&Bound<'py, PyAny>>,
) -> Result<Bound<'py, PyAny>> {
    let setup = Setup::of_counts(Scenario::of(scenario)?.seeded(None))?;
    setup.check_network()?;
    let lent = Lent::new(histograms, &setup.params.histogram)?;
    let explained = lent.rows()?.map(|row| json!(quantize::explain(&setup.network, row)));
    let mut all: Vec<Value> = explained.collect();
    let all = match (lent.is_single(), all.pop()) {
        (true, Some(only)) => only,
        (_, last) => all.into_iter().chain(last).collect(),
    };
    Ok(object(py, &all)?)
}
