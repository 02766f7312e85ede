//! `tofsim.Board`: a real board.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use tofsim::Setup;
use tofsim::error::{Input, Result as Outcome};
use tofsim_board::names::{Setting, register};
use tofsim_board::port::{BAUD, BAUDS, TIMEOUTS_S};
use tofsim_board::{PortOptions, check_frames, dark_note};
use tofsim_cli::report::board_info::BoardFindings;
use tofsim_cli::report::writer::Findings;
use tofsim_learn::characterisation::rom::{CalibratedRom, RomEntry};
use tofsim_learn::estimation::notes::notes_of_firmware;

use crate::errors::Result;
use crate::frames::{Columns, Frames};
use crate::objects::object;
use crate::running::{self, Terms, Watch};
use crate::scenario::Scenario;

// Python shows a default that is a number.
const _: () = assert!(BAUD == 921_600);

/// A real board over its serial port: frames, calibration, registers by name. It must have been built with the
/// parameters of the scenario, unless `any_parameters` is given.
///
/// The laser is on only while frames are taken with `laser=True`. Used in a `with` statement, the board's port is closed
/// at its end.
#[pyclass(module = "tofsim", frozen)]
pub struct Board {
    setup: Arc<Setup>,
    port: String,
    board: Arc<Mutex<Option<tofsim_board::Board>>>,
}

impl Board {
    /// Does something with the board, without Python's lock and open to interruptions.
    fn with<T: Send + 'static>(
        &self,
        py: Python<'_>,
        progress: Option<Py<PyAny>>,
        task: impl FnOnce(&mut tofsim_board::Board, &Watch) -> Outcome<T> + Send + 'static,
    ) -> Result<T> {
        let (board, port) = (Arc::clone(&self.board), self.port.clone());
        running::run(py, Terms { threads: Some(1), progress }, move |watch| {
            let mut board = board.lock().unwrap_or_else(PoisonError::into_inner);
            let closed = || Input::new(port, "expected an open board: this one has been closed");
            task(board.as_mut().ok_or_else(closed)?, watch)
        })
    }
}

#[pymethods]
impl Board {
    #[new]
    #[pyo3(signature = (port, scenario = None, *, baud = 921_600, timeout = 1.0, any_parameters = false))]
    fn new(
        py: Python<'_>,
        port: String,
        scenario: Option<&Bound<'_, PyAny>>,
        baud: u32,
        timeout: f64,
        any_parameters: bool,
    ) -> Result<Self> {
        if !TIMEOUTS_S.contains(&timeout) {
            let (least, most) = TIMEOUTS_S.into_inner();
            let expected = format!("expected {least} to {most} s");
            return Err(Input::new("timeout", expected).value(timeout).into());
        }
        if !BAUDS.contains(&baud) {
            let (least, most) = BAUDS.into_inner();
            return Err(Input::new("baud", format!("expected {least} to {most}"))
                .value(baud)
                .into());
        }
        let setup = Arc::new(Setup::new(Scenario::of(scenario)?.seeded(None))?);
        let patience = Duration::from_secs_f64(timeout);
        let options = PortOptions { port: port.clone(), baud, patience };
        let own = Arc::clone(&setup);
        let board = running::run(py, Terms { threads: Some(1), progress: None }, move |_| {
            tofsim_board::Board::open(&options, &own, any_parameters)
        })?;
        Ok(Board { setup, port, board: Arc::new(Mutex::new(Some(board))) })
    }

    /// Takes frames, dark ones unless `laser` is set. The board's counters of frames go on, `index` begins with 0.
    ///
    /// What a board does not count by frame, as `tdc_hits` and cycles, is 0.
    #[pyo3(signature = (count = 1, *, laser = false, progress = None))]
    fn frames(
        &self,
        py: Python<'_>,
        count: u64,
        laser: bool,
        progress: Option<Py<PyAny>>,
    ) -> Result<Frames> {
        if count == 0 {
            return Err(Input::new("count", "expected 1 at least").value(0).into());
        }
        check_frames(&self.setup)?;
        let setup = Arc::clone(&self.setup);
        let columns = self.with(py, progress, move |board, watch| {
            let mut columns = Columns::new(&setup, count, false)?;
            let (port, stop) = (board.port().to_owned(), Some(&*watch.stop));
            board.take_frames(&setup, laser, count, stop, &mut |frame, state| {
                if laser {
                    state.check_armed(&port)?;
                }
                watch.add(count);
                columns.push(frame);
                Ok(())
            })?;
            columns.notes = dark_note("laser", laser).into_iter().collect();
            columns.notes.extend(notes_of_firmware(&setup));
            Ok(columns)
        })?;
        Frames::new(py, Arc::clone(&self.setup), columns)
    }

    /// Counts at least so many hits of the ring oscillator, with the laser off, and computes the decoder's ROM from their
    /// code density: arrays by `n`.
    ///
    /// `age_se_ps` is the standard error of `age_ps`, `units` the word of the ROM. The delay to tap 0, which counts cannot
    /// measure, is that of the scenario's chain.
    #[pyo3(signature = (hits = 1_048_576, *, progress = None))]
    fn calibrate<'py>(
        &self,
        py: Python<'py>,
        hits: u32,
        progress: Option<Py<PyAny>>,
    ) -> Result<Bound<'py, PyDict>> {
        if hits == 0 {
            return Err(Input::new("hits", "expected 1 at least").value(0).into());
        }
        let setup = Arc::clone(&self.setup);
        let rom = self.with(py, progress, move |board, watch| {
            let mut counted = |now: u32| watch.tell(now.into(), hits.into());
            let counts = board.code_density(&setup, hits, Some(&watch.stop), &mut counted)?;
            Ok(CalibratedRom::new(board.port(), &counts, &setup.params.tdc)?)
        })?;
        let whole =
            |of: fn(&RomEntry) -> u64| PyArray1::from_vec(py, rom.entries.iter().map(of).collect());
        let real =
            |of: fn(&RomEntry) -> f64| PyArray1::from_vec(py, rom.entries.iter().map(of).collect());
        let found = PyDict::new(py);
        found.set_item("count", whole(|entry| entry.count))?;
        found.set_item("age_ps", real(|entry| entry.age_ps))?;
        found.set_item("age_se_ps", real(|entry| entry.age_se_ps))?;
        found.set_item("units", whole(|entry| entry.units))?;
        Ok(found)
    }

    /// Disarms and disables the laser, and holds frames back.
    fn laser_off(&self, py: Python<'_>) -> Result<()> {
        self.with(py, None, |board, _| board.laser_off())
    }

    /// What the board is, and its state: the object of `tofsim board info --json` without its record.
    fn info<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let setup = Arc::clone(&self.setup);
        let findings = self.with(py, None, move |board, _| BoardFindings::read(board, &setup))?;
        Ok(object(py, &findings.json())?)
    }

    /// Name of the port.
    #[getter]
    fn port(&self) -> &str {
        &self.port
    }

    /// Name of the scenario.
    #[getter]
    fn scenario(&self) -> &str {
        &self.setup.name
    }

    /// The value of a register or of a field of `control`: `board["frames"]`, `board["laser_freq"]`.
    fn __getitem__(&self, py: Python<'_>, name: String) -> Result<u64> {
        let setting = Setting::all().find(|setting| setting.name() == name);
        let asked = self.port.clone();
        self.with(py, None, move |board, _| match setting {
            Some(setting) => board.setting(setting).map(u64::from),
            None => board.read(register(&asked, &name)?),
        })
    }

    /// Sets a register or a field of `control`: `board["laser_freq"] = 2`.
    fn __setitem__(&self, py: Python<'_>, name: &str, value: i64) -> Result<()> {
        let setting = Setting::named(&self.port, name)?;
        let value = setting.value(&self.port, &value.to_string())?;
        self.with(py, None, move |board, _| board.set(setting, value))
    }

    /// Closes the port, with the laser off if frames were taken.
    fn close(&self, py: Python<'_>) {
        let board = Arc::clone(&self.board);
        py.detach(|| drop(board.lock().unwrap_or_else(PoisonError::into_inner).take()));
    }

    fn __enter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    #[pyo3(signature = (*_exception))]
    fn __exit__(&self, py: Python<'_>, _exception: &Bound<'_, PyTuple>) {
        self.close(py);
    }

    fn __repr__(&self) -> String {
        format!("<tofsim.Board {} at {}>", self.setup.name, self.port)
    }
}
