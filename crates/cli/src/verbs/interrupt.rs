//! Interruption by the user.
//!
//! A verb that looks at [`stop_signal`] ends of itself. Any other is ended at once, and so is one that
//! is interrupted again; what it has under construction goes in both cases.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use tofsim::error::tell;
use tofsim::files::unfinished::discard_all;

use super::host::host;

/// Exit status of an interrupted program, as shells have it.
pub const INTERRUPTED: u8 = 130;

/// Flag that the running verb polls.
static LOOKS: Mutex<Option<Arc<AtomicBool>>> = Mutex::new(None);

/// Begins to listen, if the system offers a way to.
pub fn listen() {
    let heard = || {
        let looks = LOOKS.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if looks.is_none_or(|stop| stop.swap(true, Ordering::Relaxed)) {
            discard_all();
            say();
            std::process::exit(INTERRUPTED.into());
        }
    };
    // Without a way, the system ends the program, which is as good but for what is left.
    drop(ctrlc::set_handler(heard));
    keep_file_limits();
}

/// Lets a file that may not grow any more be an error of writing, where the system would end the program.
#[cfg(unix)]
fn keep_file_limits() {
    use signal_hook::{consts::SIGXFSZ, flag::register};
    drop(register(SIGXFSZ, Arc::default()));
}

#[cfg(not(unix))]
fn keep_file_limits() {}

/// Says that it was interrupted.
pub fn say() {
    tell("tofsim: interrupted");
}

/// Set when the user interrupts, or the program around the verb stops it; from now on the verb looks at it.
pub fn stop_signal() -> Option<Arc<AtomicBool>> {
    if let Some(host) = host() {
        return Some(host.stop);
    }
    let stop = Arc::new(AtomicBool::new(false));
    *LOOKS.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::clone(&stop));
    Some(stop)
}

/// Stops polling the flag.
pub fn look_no_more() {
    if host().is_some() {
        return;
    }
    *LOOKS.lock().unwrap_or_else(PoisonError::into_inner) = None;
}
