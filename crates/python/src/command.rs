//! The command, in the wheel and as a function.

use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use serde_json::Value;

use tofsim_cli::verbs::Cli;
use tofsim_cli::verbs::host::Host;
use tofsim_cli::verbs::rerun::PROGRAM;

use crate::errors::{Result, internal};
use crate::objects::object;
use crate::running::{self, Terms};

/// Does what a command line asks for, whose first word is the program; its exit status.
#[pyfunction]
pub fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
    let program = words.first().map(PathBuf::from).filter(|path| path.is_file());
    if let Some(path) = program.and_then(|path| std::path::absolute(path).ok()) {
        PROGRAM.get_or_init(|| path);
    }
    py.detach(|| {
        let status = tofsim_cli::run(words);
        // A reader that has gone is no fault.
        let _ = std::io::stdout().flush();
        status
    })
}

/// Runs a command line, and returns its `--json` object as a dictionary, and whether its status was 0. The first word
/// is a verb.
#[pyfunction]
#[pyo3(name = "_answer", signature = (words, threads = None, progress = None))]
pub fn answer<'py>(
    py: Python<'py>,
    words: Vec<String>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> Result<(Bound<'py, PyAny>, bool)> {
    let answer = running::run(py, Terms { threads, progress }, move |watch| {
        let (own, stop) = (watch.clone(), Arc::clone(&watch.stop));
        let host = Host::new(stop, Arc::new(move |done, all| own.tell(done, all)));
        Cli::answer(&words, host)
    })?;
    let text = answer.text.trim();
    let value = if text.is_empty() { Ok(Value::Null) } else { serde_json::from_str(text) };
    let value = value.map_err(|_| internal("the command printed no JSON: expected --json"))?;
    Ok((object(py, &value)?, answer.is_fine))
}
