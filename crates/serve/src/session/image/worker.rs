//! The thread that simulates images, while requests are answered.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use tofsim::error::{Input, Result};
use tofsim::scenario::Loaded;
use tofsim::sim::image::ImageFidelity;

use super::simulation::{Image, Simulation, Stops};

/// What a task has come to.
pub struct Outcome {
    /// The image, or why there is none.
    pub image: Result<Image>,
    /// Time spent on it.
    pub busy: Duration,
}

/// Request for the next image: of the scenario, if it is a new one.
struct Task {
    begin: Option<Loaded>,
    stops: Stops,
}

/// Handle of the thread, which ends after its last task once the handle is dropped.
pub struct Worker {
    tasks: Sender<Task>,
    outcomes: Receiver<Outcome>,
    /// Flags of the present task.
    stops: Option<Stops>,
    simulated: Arc<AtomicU64>,
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.abandon();
    }
}

impl Worker {
    /// Starts the thread.
    ///
    /// # Errors
    /// If the system has no thread.
    pub fn start(fidelity: ImageFidelity) -> Result<Self> {
        let ((tasks, given), (ended, outcomes)) = (channel(), channel());
        let simulated = Arc::new(AtomicU64::new(0));
        let mut simulation = Simulation::new(fidelity, Arc::clone(&simulated));
        let run = move || {
            for Task { begin, stops } in given {
                let began = Instant::now();
                let image = simulation.image(begin, &stops);
                if ended.send(Outcome { image, busy: began.elapsed() }).is_err() {
                    return;
                }
            }
        };
        let thread = thread::Builder::new().name("images".to_owned()).spawn(run);
        thread.map_err(|error| Input::new("simulation", error))?;
        Ok(Worker { tasks, outcomes, stops: None, simulated })
    }

    /// Begins the next image, or the first one of a scenario.
    pub fn simulate(&mut self, begin: Option<Loaded>) {
        let stops = Stops::default();
        self.stops = Some(stops.clone());
        // Without the thread, waiting for it fails.
        drop(self.tasks.send(Task { begin, stops }));
    }

    /// Returns whether the outcome of a task has not been taken.
    pub fn is_busy(&self) -> bool {
        self.stops.is_some()
    }

    /// Stops the image of the present task, if there is one; its outcome is still to be taken.
    pub fn interrupt(&self) {
        if let Some(stops) = &self.stops {
            stops.image.store(true, Ordering::Relaxed);
        }
    }

    /// Stops the present task, if there is one, because its scenario is not wanted any more.
    pub fn abandon(&self) {
        self.interrupt();
        if let Some(stops) = &self.stops {
            stops.elaboration.store(true, Ordering::Relaxed);
        }
    }

    /// Returns the number of pixels that the present image has.
    pub fn simulated(&self) -> u64 {
        self.simulated.load(Ordering::Relaxed)
    }

    /// Waits for the outcome of the present task.
    pub fn wait(&mut self, patience: Duration) -> Option<Outcome> {
        let outcome = match self.outcomes.recv_timeout(patience) {
            Ok(outcome) => outcome,
            Err(RecvTimeoutError::Timeout) => return None,
            Err(RecvTimeoutError::Disconnected) => {
                let image = Err(Input::new("simulation", "the thread has panicked").into());
                Outcome { image, busy: Duration::ZERO }
            }
        };
        self.stops = None;
        Some(outcome)
    }
}
