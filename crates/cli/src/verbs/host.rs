//! A command line within another program, as the Python package: that has what is printed, may stop the verb, and
//! hears how far it is.

use std::cell::RefCell;
use std::io::{self, Write};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

/// Hears how much of how much is done.
pub type HearProgress = Arc<dyn Fn(u64, u64) + Send + Sync>;

/// The program around a command.
#[derive(Clone)]
pub struct Host {
    /// Set to stop the verb, if it is one that looks at such a signal.
    pub stop: Arc<AtomicBool>,
    /// Hears of the progress of a task whose size is known.
    pub progress: HearProgress,
    printed: Printed,
}

#[derive(Clone, Default)]
struct Printed(Arc<Mutex<Vec<u8>>>);

impl Write for Printed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

thread_local! {
    static HOST: RefCell<Option<Host>> = const { RefCell::new(None) };
}

/// The program around the verb of this thread, if there is one.
pub fn host() -> Option<Host> {
    HOST.with_borrow(Clone::clone)
}

/// Returns the output of a verb of this thread.
pub fn output() -> Box<dyn Write> {
    match host() {
        Some(host) => Box::new(host.printed),
        None => Box::new(io::stdout().lock()),
    }
}

impl Host {
    /// A program that stops a verb by `stop`.
    pub fn new(stop: Arc<AtomicBool>, progress: HearProgress) -> Host {
        Host { stop, progress, printed: Printed::default() }
    }

    /// Does a verb's work, which prints here and nowhere else; what it printed.
    pub fn around<T>(self, work: impl FnOnce() -> T) -> (T, String) {
        let printed = self.printed.clone();
        let outer = HOST.replace(Some(self));
        let done = work();
        HOST.set(outer);
        let bytes = printed.0.lock().unwrap_or_else(PoisonError::into_inner);
        (done, String::from_utf8_lossy(&bytes).into_owned())
    }
}
