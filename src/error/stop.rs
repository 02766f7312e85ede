use std::sync::atomic::{AtomicBool, Ordering};

use super::fault::{Error, Result};

/// Polls the flag by which a run is stopped from outside.
///
/// # Errors
/// [`Error::Interrupted`] once `stop` is set.
#[inline]
pub fn poll_stop(stop: Option<&AtomicBool>) -> Result<()> {
    let stopped = stop.is_some_and(|stop| stop.load(Ordering::Relaxed));
    if stopped { Err(Error::Interrupted) } else { Ok(()) }
}
