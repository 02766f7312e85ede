//! Light that comes back, and depths of your own histograms.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;
use serde_json::{Value, json};

use tofsim::Setup;
use tofsim::error::{Input, poll_stop};
use tofsim_cli::report::link_budget::LinkBudget;
use tofsim_cli::report::writer::Findings;
use tofsim_learn::estimation::{Estimate, EstimatorKind, Panel};
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
    let findings = LinkBudget::of(Setup::of_counts(Scenario::of(scenario)?.seeded(None))?);
    let mut found = findings.object();
    found["notes"] = json!(findings.notes()?);
    Ok(object(py, &found)?)
}

/// The estimators of those names.
fn kinds(names: &[String]) -> Result<Vec<EstimatorKind>> {
    let kind = |name: &String| {
        let known = || EstimatorKind::names().collect::<Vec<_>>().join(", ");
        let fault = || Input::new("estimators", format!("expected some of {}", known()));
        Ok(EstimatorKind::find(name).ok_or_else(|| fault().value(name))?)
    };
    names.iter().map(kind).collect()
}

/// Depths of histograms, one or n x bins, as a dictionary of arrays: `estimator`, `depth_m`, `depth_raw`, `sigma_m`,
/// `valid` and `status` of the firmware's own estimator, bit for bit, and for each of `estimators` its depth, which is
/// NaN where it fails [m]. `estimates` has the same of each of `estimators` by its name.
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
    let own = setup.params.estimator.estimator();
    let kinds = kinds(&estimators)?;
    let lent = Lent::new(histograms, &setup.params.histogram)?;
    // The task may be left to itself, and Python's memory not.
    let rows: Vec<Vec<u32>> = lent.rows()?.map(<[u32]>::to_vec).collect();
    let all = running::run(py, Terms { threads, progress: None }, move |watch| {
        let panel = Panel::new(&kinds, &setup)?;
        let one = |row: &Vec<u32>| {
            poll_stop(Some(&watch.stop))?;
            let mut estimates = vec![setup.estimate(row)];
            estimates.extend(panel.read(row));
            Ok(estimates)
        };
        rows.par_iter().map(one).collect::<tofsim::Result<Vec<_>>>()
    })?;
    let columns = |place: usize| columns(py, all.iter().map(|each| &each[place]));
    let found = columns(0)?;
    found.set_item("estimator", own)?;
    let words =
        all.iter().filter_map(|each| each[0].depth_raw).map(|word| word.to_bits()).collect();
    found.set_item("depth_raw", PyArray1::<i64>::from_vec(py, words))?;
    let others = PyDict::new(py);
    for (place, name) in estimators.iter().enumerate() {
        let estimates = columns(place + 1)?;
        estimates.set_item("estimator", name)?;
        found.set_item(name, estimates.get_item("depth_m")?)?;
        others.set_item(name, estimates)?;
    }
    found.set_item("estimates", others)?;
    Ok(found)
}

/// The estimates of one estimator as arrays, and their statuses as lists of words.
fn columns<'py, 'a>(
    py: Python<'py>,
    estimates: impl Iterator<Item = &'a Estimate> + Clone,
) -> Result<Bound<'py, PyDict>> {
    let metres = |of: fn(&Estimate) -> Option<f64>| {
        let all = estimates.clone().map(|one| of(one).unwrap_or(f64::NAN)).collect();
        PyArray1::<f64>::from_vec(py, all)
    };
    let found = PyDict::new(py);
    found.set_item("depth_m", metres(|one| one.depth_m))?;
    found.set_item("sigma_m", metres(|one| one.sigma_m))?;
    let valid = estimates.clone().map(|one| one.valid).collect();
    found.set_item("valid", PyArray1::<bool>::from_vec(py, valid))?;
    let status: Vec<_> = estimates.clone().map(|one| one.status.words()).collect();
    found.set_item("status", status)?;
    let codes: Vec<_> = estimates.map(|one| one.status_code.word()).collect();
    found.set_item("status_code", codes)?;
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
