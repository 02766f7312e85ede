//! Watches over the waveform library, which panics on many a fault.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

use tofsim::error::{Input, Result};

thread_local! {
    /// Whether a panic of this thread becomes an error.
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Lets the library do something; a panic of it is an error about `source`.
pub(super) fn guarded<T>(source: &str, work: impl FnOnce() -> Result<T>) -> Result<T> {
    silence();
    let before = GUARDED.replace(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    GUARDED.set(before);
    result
        .unwrap_or_else(|_| Err(Input::new(source, "is damaged, or not as its format asks").into()))
}

/// Keeps panics that become errors off standard error.
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
