//! The thread that simulates images, while requests are answered.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use tofsim::error::{Input, Result};
use tofsim::scenario::Loaded;
use tofsim::sim::image::{Expected, ImageFidelity, LiveImages, PixelFrame};
use tofsim::sim::setup::array::ArraySetup;

use crate::served::notes_of_array;

/// A simulated image.
pub struct Image {
    /// Its number, from 0.
    pub number: u64,
    /// Hash of its scenario.
    pub hash: Arc<str>,
    /// What the frames of each pixel can be expected to hold, by row, then column.
    pub expected: Arc<[Expected]>,
    /// The frame of each pixel.
    pub frames: Vec<PixelFrame>,
    /// Notes on its depths.
    pub notes: Arc<[String]>,
}

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

/// Flags that stop a task.
#[derive(Clone, Default)]
struct Stops {
    /// Stops the image, which goes on from there in the next task.
    image: Arc<AtomicBool>,
    /// Stops the elaboration of the pixels, which begins again.
    elaboration: Arc<AtomicBool>,
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
        let mut simulation =
            Simulation { fidelity, loaded: None, array: None, simulated: Arc::clone(&simulated) };
        let run = move || {
            for task in given {
                if ended.send(simulation.run(task)).is_err() {
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

/// State of the thread.
struct Simulation {
    fidelity: ImageFidelity,
    loaded: Option<Loaded>,
    /// Elaborated pixels of the scenario.
    array: Option<Array>,
    simulated: Arc<AtomicU64>,
}

struct Array {
    images: LiveImages,
    hash: Arc<str>,
    expected: Arc<[Expected]>,
    notes: Arc<[String]>,
}

impl Simulation {
    fn run(&mut self, Task { begin, stops }: Task) -> Outcome {
        let began = Instant::now();
        if begin.is_some() {
            (self.loaded, self.array) = (begin, None);
            self.simulated.store(0, Ordering::Relaxed);
        }
        let image = self.next_image(&stops);
        Outcome { image, busy: began.elapsed() }
    }

    fn next_image(&mut self, stops: &Stops) -> Result<Image> {
        let array = match (&mut self.array, &self.loaded) {
            (Some(array), _) => array,
            (none, Some(loaded)) => {
                none.insert(Array::new(loaded, self.fidelity, &stops.elaboration)?)
            }
            (None, None) => return Err(Input::new("simulation", "expected a scenario").into()),
        };
        let number = array.images.done();
        let simulated = || _ = self.simulated.fetch_add(1, Ordering::Relaxed);
        let frames = array.images.next_image(Some(&stops.image), &simulated)?;
        self.simulated.store(0, Ordering::Relaxed);
        let Array { hash, expected, notes, .. } = array;
        let (hash, expected, notes) = (Arc::clone(hash), Arc::clone(expected), Arc::clone(notes));
        Ok(Image { number, hash, expected, frames, notes })
    }
}

impl Array {
    fn new(loaded: &Loaded, fidelity: ImageFidelity, stop: &AtomicBool) -> Result<Self> {
        let array = ArraySetup::new(loaded.clone())?;
        let images = LiveImages::new(&array, fidelity, Some(stop))?;
        let notes = notes_of_array(array.common(), images.notes());
        Ok(Array {
            hash: array.common().hash().into(),
            expected: images.expected().into(),
            notes: notes.iter().map(ToString::to_string).collect(),
            images,
        })
    }
}
