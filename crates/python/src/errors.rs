//! The library's errors as Python's exceptions.

use pyo3::PyErr;
use pyo3::create_exception;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use tofsim::error::{Error, Input};

create_exception!(
    tofsim,
    InputError,
    PyValueError,
    "Something in an input is not what it should be: `file`, `line`, `column`, `key`, `value`, `expected`."
);

/// Shorthand for what may raise an exception.
pub type Result<T> = std::result::Result<T, Fault>;

/// An error on the way to Python.
#[derive(Debug)]
pub enum Fault {
    /// In the library.
    Library(Error),
    /// In Python, as a callback's exception or a signal's.
    Python(PyErr),
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        Fault::Library(error)
    }
}

impl From<Input> for Fault {
    fn from(input: Input) -> Self {
        Fault::Library(input.into())
    }
}

impl From<PyErr> for Fault {
    fn from(error: PyErr) -> Self {
        Fault::Python(error)
    }
}

impl From<Fault> for PyErr {
    fn from(fault: Fault) -> PyErr {
        match fault {
            Fault::Python(error) => error,
            Fault::Library(Error::Interrupted) => PyKeyboardInterrupt::new_err(()),
            Fault::Library(Error::Input(input)) => raised(&input),
            Fault::Library(Error::Io { path, action, source }) => match source.raw_os_error() {
                // Python finds the class by the number, as FileNotFoundError.
                Some(number) => {
                    let text = format!("cannot {action}: {source}");
                    PyOSError::new_err((number, text, path.display().to_string()))
                }
                None => PyOSError::new_err(Error::Io { path, action, source }.to_string()),
            },
        }
    }
}

/// The exception with its parts as attributes.
fn raised(input: &Input) -> PyErr {
    let error = InputError::new_err(input.to_string());
    let told = Python::attach(|py| {
        let value = error.value(py);
        value.setattr("file", &input.source)?;
        value.setattr("line", input.place.map(|(line, _)| line))?;
        value.setattr("column", input.place.map(|(_, column)| column))?;
        value.setattr("key", &input.field)?;
        value.setattr("value", &input.value)?;
        value.setattr("expected", &input.expected)
    });
    told.map_or_else(|fault| fault, |()| error)
}

/// Refuses what a function was given, as the library does.
#[pyfunction]
#[pyo3(name = "_refuse", signature = (source, expected, *, key = None, value = None))]
pub fn refuse(
    source: String,
    expected: String,
    key: Option<String>,
    value: Option<String>,
) -> Result<()> {
    Err(Input { field: key, value, ..Input::new(source, expected) }.into())
}

/// A fault of ours.
pub fn internal(what: &str) -> Fault {
    Fault::Python(PyRuntimeError::new_err(what.to_owned()))
}
