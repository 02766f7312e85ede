//! Conversion of panics in the waveform library, which panics on many invalid files, to errors.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

use tofsim::error::{Input, Result};

/// Reason for a file that the library cannot read, and does not say why.
pub(super) const DAMAGED: &str = "is damaged, or not as its format asks";

thread_local! {
    /// Whether panics of this thread are converted to errors.
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Runs a call of the library. A panic becomes an error about `source`.
pub(super) fn guarded<T>(source: &str, work: impl FnOnce() -> Result<T>) -> Result<T> {
    silence();
    let before = GUARDED.replace(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    GUARDED.set(before);
    result.unwrap_or_else(|_| Err(Input::new(source, DAMAGED).into()))
}

/// Suppresses the output of panics that become errors.
fn silence() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if !GUARDED.get() {
                before(panic);
            }
        }));
    });
}
