//! How a run reports.

use crate::error::Result;

/// Receives the results of a run one by one; an error ends the run.
pub type Callback<'a, T> = &'a mut dyn FnMut(&T) -> Result<()>;

/// Calls back with a result, if somebody wants it.
pub(super) fn call<T>(callback: &mut Option<Callback<T>>, result: &T) -> Result<()> {
    callback.as_mut().map_or(Ok(()), |callback| callback(result))
}
