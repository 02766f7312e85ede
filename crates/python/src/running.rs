//! A long task: in a thread of its own, so that Python goes on and may interrupt it.

use std::any::Any;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;

use tofsim::error::{Input, Result};
use tofsim_cli::choice::MOST_THREADS;
use tofsim_cli::verbs::draws::useful;

use crate::errors::{self, internal};

/// Time between two looks at signals, and at progress.
const LOOK: Duration = Duration::from_millis(20);
/// Time that a task has to stop; what does not is left to itself, and what it finds is lost.
const PATIENCE: Duration = Duration::from_millis(150);

/// Progress and stop flag of a task.
#[derive(Clone, Default)]
pub struct Watch {
    /// Set to stop it.
    pub stop: Arc<AtomicBool>,
    done: Arc<AtomicU64>,
    all: Arc<AtomicU64>,
}

impl Watch {
    /// So much of so much is done.
    pub fn tell(&self, done: u64, all: u64) {
        self.all.store(all, Ordering::Relaxed);
        self.done.store(done, Ordering::Relaxed);
    }

    /// One more of so much is done.
    pub fn add(&self, all: u64) {
        self.all.store(all, Ordering::Relaxed);
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    /// Returns the finished and the total amount.
    fn position(&self) -> (u64, u64) {
        (self.done.load(Ordering::Relaxed), self.all.load(Ordering::Relaxed))
    }
}

/// How a task runs.
#[derive(Default)]
pub struct Terms {
    /// Threads; one a core without a number.
    pub threads: Option<usize>,
    /// Called with how much of how much is done; its exception ends the task.
    pub progress: Option<Py<PyAny>>,
}

/// Does a task without Python's lock, on a pool of threads of its own.
///
/// # Errors
/// When the task fails or is interrupted, or the progress function raises an exception.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    terms: Terms,
    task: impl FnOnce(&Watch) -> Result<T> + Send + 'static,
) -> errors::Result<T> {
    let most = MOST_THREADS as usize;
    if let Some(threads) = terms.threads.filter(|threads| !(1..=most).contains(threads)) {
        return Err(Input::new("threads", format!("expected 1 to {most}")).value(threads).into());
    }
    let threads = terms.threads.map_or(0, useful);
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| Input::new("threads", error))?;
    let watch = Watch::default();
    let (sender, receiver) = channel();
    let own = watch.clone();
    let spawned = thread::Builder::new().name("tofsim".to_owned()).spawn(move || {
        // Nobody listens any more to one that was not waited for.
        let _ = sender.send(pool.install(|| task(&own)));
    });
    let worker = spawned.map_err(|error| Input::new("threads", error))?;
    let receiver = Mutex::new(receiver);
    let wait = |time| py.detach(|| received(&receiver, time));
    let mut reported = (0, 0);
    loop {
        match wait(LOOK) {
            Ok(result) => {
                tell(py, &terms, &watch, &mut reported)?;
                return Ok(result?);
            }
            Err(RecvTimeoutError::Disconnected) => {
                let panic = worker.join().err();
                return Err(internal(&panic.map_or("no result".to_owned(), said)));
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        let heard = py.check_signals().and_then(|()| tell(py, &terms, &watch, &mut reported));
        if let Err(why) = heard {
            watch.stop.store(true, Ordering::Relaxed);
            drop(wait(PATIENCE));
            return Err(why.into());
        }
    }
}

fn received<T>(
    receiver: &Mutex<Receiver<T>>,
    time: Duration,
) -> std::result::Result<T, RecvTimeoutError> {
    receiver.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(time)
}

/// Calls the progress function if the position has changed since it was `reported`.
fn tell(py: Python<'_>, terms: &Terms, watch: &Watch, reported: &mut (u64, u64)) -> PyResult<()> {
    let now = watch.position();
    let Some(progress) = terms.progress.as_ref().filter(|_| now != *reported) else {
        return Ok(());
    };
    *reported = now;
    progress.call1(py, now).map(drop)
}

/// Returns the message of a panic.
fn said(panic: Box<dyn Any + Send>) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| text.to_string());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    format!("a fault in tofsim: {}", text.unwrap_or_else(|| "unknown".to_owned()))
}
