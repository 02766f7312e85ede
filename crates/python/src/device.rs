//! `tofsim.Device`: the instrument, edge by edge.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use tofsim::Setup;
use tofsim::error::{Input, poll_stop};
use tofsim::sim::stepped::{SignalHandle, SteppedRun};

use crate::arrays::table;
use crate::errors::Result;
use crate::frame::Frame;
use crate::running::{self, Terms};
use crate::scenario::Scenario;

/// Edges between two looks at whether to stop.
const BETWEEN: u64 = 1 << 12;

/// The instrument in the hands of its user: it is stepped by edges of `clk_sys`, its signals have names, and the pins
/// of the acquisition computer can be driven. A signal's value is the one that the last edge took.
#[pyclass(module = "tofsim", frozen)]
pub struct Device {
    setup: Arc<Setup>,
    state: Arc<Mutex<State>>,
}

struct State {
    run: SteppedRun,
    frames: Vec<tofsim::Frame>,
    handles: HashMap<String, SignalHandle>,
}

impl State {
    fn step(&mut self) {
        let frame = self.run.step();
        self.frames.extend(frame);
    }

    fn handle(&mut self, name: &str) -> Result<SignalHandle> {
        if let Some(handle) = self.handles.get(name) {
            return Ok(*handle);
        }
        let handle = self.run.find(name)?;
        self.handles.insert(name.to_owned(), handle);
        Ok(handle)
    }
}

fn locked(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}

#[pymethods]
impl Device {
    #[new]
    #[pyo3(signature = (scenario = None, *, seed = None, keep_stops = false))]
    fn new(
        scenario: Option<&Bound<'_, PyAny>>,
        seed: Option<u64>,
        keep_stops: bool,
    ) -> Result<Self> {
        let setup = Arc::new(Setup::new(Scenario::of(scenario)?.seeded(seed))?);
        let run = SteppedRun::new(Arc::clone(&setup));
        let run = if keep_stops { run.keeping_stops() } else { run };
        let state = State { run, frames: Vec::new(), handles: HashMap::new() };
        Ok(Device { setup, state: Arc::new(Mutex::new(state)) })
    }

    /// Takes so many edges of `clk_sys`; the number of the last one, from 0 at power-up.
    #[pyo3(signature = (edges = 1))]
    fn step(&self, py: Python<'_>, edges: u64) -> Result<Option<u64>> {
        if edges <= BETWEEN {
            let mut state = locked(&self.state);
            (0..edges).for_each(|_| state.step());
            return Ok(state.run.cycle().map(|cycle| cycle.number));
        }
        let state = Arc::clone(&self.state);
        running::run(py, Terms { threads: Some(1), progress: None }, move |watch| {
            let mut state = locked(&state);
            for edge in 0..edges {
                if edge % BETWEEN == 0 {
                    poll_stop(Some(&watch.stop))?;
                }
                state.step();
            }
            Ok(state.run.cycle().map(|cycle| cycle.number))
        })
    }

    /// Takes so many edges and has the values of some signals at each: a column of integers for each signal.
    fn trace<'py>(
        &self,
        py: Python<'py>,
        edges: u64,
        signals: Vec<String>,
    ) -> Result<Bound<'py, PyArray2<i64>>> {
        let mut state = locked(&self.state);
        let handles: Result<Vec<_>> = signals.iter().map(|name| state.handle(name)).collect();
        let handles = handles?;
        drop(state);
        let (state, columns) = (Arc::clone(&self.state), handles.len());
        let values = running::run(py, Terms { threads: Some(1), progress: None }, move |watch| {
            let mut state = locked(&state);
            let mut values = Vec::new();
            for edge in 0..edges {
                if edge % BETWEEN == 0 {
                    poll_stop(Some(&watch.stop))?;
                }
                state.step();
                values.extend(handles.iter().map(|handle| state.run.value(*handle)));
            }
            Ok(values)
        })?;
        Ok(table(py, values, columns)?)
    }

    /// The number of the last edge of `clk_sys`, from 0, if there was one.
    #[getter]
    fn cycle(&self) -> Option<u64> {
        locked(&self.state).run.cycle().map(|cycle| cycle.number)
    }

    /// The instant of the last edge [fs].
    #[getter]
    fn time_fs(&self) -> Option<u64> {
        locked(&self.state).run.cycle().map(|cycle| cycle.begin.fs())
    }

    /// Paths of the signals below the top, each with what it is.
    #[getter]
    fn signals<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>> {
        let found = PyDict::new(py);
        for entry in locked(&self.state).run.signals() {
            found.set_item(entry.below_top(), entry.signal.doc.trim())?;
        }
        Ok(found)
    }

    /// The frames that were finished since this was last asked for.
    fn frames(&self) -> Vec<Frame> {
        let frames = std::mem::take(&mut locked(&self.state).frames);
        frames.iter().map(|frame| Frame::new(Arc::clone(&self.setup), frame)).collect()
    }

    /// The instants at which `tdc_stop` changed since this was last asked for [fs]; the first change is a rise. The last
    /// step goes on past its edge for three quarters of a cycle.
    fn stops<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyArray1<u64>>> {
        let kept = locked(&self.state).run.take_stops();
        let fault = || Input::new("stops", "expected a device with keep_stops=True");
        let stops = kept.ok_or_else(fault)?.iter().map(|at| at.fs()).collect();
        Ok(PyArray1::from_vec(py, stops))
    }

    /// Drives pins of the acquisition computer from now on: `rst`, `mode`, `laser_freq`, `laser_en`, `dsp_en`, `dsp_rst`.
    #[pyo3(signature = (**pins))]
    fn drive(&self, pins: Option<&Bound<'_, PyDict>>) -> Result<()> {
        let given = pins.into_iter().flat_map(|pins| pins.iter());
        let pair = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            Ok((name.extract::<String>()?, value.extract::<i64>()?))
        };
        let given: PyResult<Vec<_>> = given.map(pair).collect();
        let mut state = locked(&self.state);
        let controls: tofsim::Result<Vec<_>> =
            given?.iter().map(|(name, value)| state.run.pin(name, *value)).collect();
        controls?.iter().for_each(|control| state.run.drive(control));
        Ok(())
    }

    /// The value of a signal that the last edge took: `device["tof_top.tdc.tdc_code"]`; the top may be left out.
    fn __getitem__(&self, name: &str) -> Result<i64> {
        let mut state = locked(&self.state);
        let handle = state.handle(name)?;
        Ok(state.run.value(handle))
    }

    fn __repr__(&self) -> String {
        let cycle = self.cycle().map_or("power-up".to_owned(), |cycle| format!("cycle {cycle}"));
        format!("<tofsim.Device {} at {cycle}>", self.setup.name)
    }
}
