//! How a run reports, and how it is stopped.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::{Error, Result};

/// Receives the results of a run one by one; an error ends the run.
pub type Callback<'a, T> = &'a mut dyn FnMut(&T) -> Result<()>;

/// Calls back with a result, if somebody wants it.
pub(super) fn call<T>(callback: &mut Option<Callback<T>>, result: &T) -> Result<()> {
    callback.as_mut().map_or(Ok(()), |callback| callback(result))
}

/// Fails once `stop` is set from outside.
pub(super) fn poll_stop(stop: Option<&AtomicBool>) -> Result<()> {
    let stopped = stop.is_some_and(|stop| stop.load(Ordering::Relaxed));
    if stopped { Err(Error::Interrupted) } else { Ok(()) }
}
