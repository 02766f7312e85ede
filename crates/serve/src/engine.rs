//! The simulating thread, and its request queue.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use tokio::sync::{oneshot, watch};

use tofsim::error::{Error, Input, Result};

use crate::options::Options;
use crate::session::request::{Request, RunRequest};
use crate::session::{BoardSession, ImageSession, Reply, Session, Source};

/// Capacity of the request queue.
const WAITING: usize = 64;
/// Number of cycles simulated between checks for requests, about a millisecond.
const CYCLES: u64 = 1 << 14;
/// Longest time between two published states during a long frame.
const SHOWN_EVERY: Duration = Duration::from_millis(100);

/// A request, with the channel for its answer.
struct Queued {
    request: Request,
    answer: oneshot::Sender<Result<Reply>>,
}

/// Handle of the simulating thread.
#[derive(Clone)]
pub struct Engine {
    asked: SyncSender<Queued>,
    states: watch::Receiver<Arc<str>>,
}

/// Reason why a request has no answer.
#[derive(Debug)]
pub enum RequestError {
    /// The request queue is full.
    Busy,
    /// The request is invalid or cannot be carried out.
    Refused(Error),
    /// The thread has ended.
    Disconnected,
}

impl Engine {
    /// Starts a run at power-up, the images of an array, or a board's frames. The thread ends once all handles have been dropped; a board is
    /// then left with the laser off.
    ///
    /// # Errors
    /// If the scenario cannot be run, or the board does not answer.
    pub fn start(options: Options) -> Result<(Self, JoinHandle<()>)> {
        let pause = Duration::from_secs(1) / options.rate;
        let mut source: Box<dyn Source> = if options.board.board.is_some() {
            Box::new(BoardSession::new(options)?)
        } else if options.shows_images(&options.load(&[])?) {
            Box::new(ImageSession::new(options)?)
        } else {
            Box::new(Session::new(options)?)
        };
        let (show, states) = watch::channel(source.state());
        let (asked, requests) = sync_channel(WAITING);
        let run = move || Thread { source, requests, show, pause, waiting: None }.run();
        let thread = thread::Builder::new().name("simulation".to_owned()).spawn(run);
        let thread = thread.map_err(|error| Input::new("simulation", error))?;
        Ok((Engine { asked, states }, thread))
    }

    /// Sends a request, and waits for the answer.
    ///
    /// # Errors
    /// The reason why there is no answer.
    pub async fn ask(&self, request: Request) -> std::result::Result<Reply, RequestError> {
        let (answer, answered) = oneshot::channel();
        self.asked.try_send(Queued { request, answer }).map_err(|error| match error {
            TrySendError::Full(_) => RequestError::Busy,
            TrySendError::Disconnected(_) => RequestError::Disconnected,
        })?;
        answered.await.map_err(|_| RequestError::Disconnected)?.map_err(RequestError::Refused)
    }

    /// Returns a receiver of the run's states. A slow receiver may miss states, but always sees the newest.
    pub fn states(&self) -> watch::Receiver<Arc<str>> {
        self.states.clone()
    }
}

/// State of the thread that takes frames.
struct Thread {
    source: Box<dyn Source>,
    requests: Receiver<Queued>,
    show: watch::Sender<Arc<str>>,
    /// Shortest time between the starts of two frames.
    pause: Duration,
    /// Request that waits for frames.
    waiting: Option<oneshot::Sender<Result<Reply>>>,
}

impl Thread {
    /// Runs until all handles have been dropped.
    fn run(mut self) {
        let (mut begun, mut shown) = (Instant::now(), Instant::now());
        loop {
            if !self.source.is_running() {
                let Ok(asked) = self.requests.recv() else { return };
                self.answer(asked);
                begun = Instant::now();
                continue;
            }
            let ended = self.source.advance(CYCLES);
            self.answer_waiting();
            let is_counting = self.source.has_batch();
            if ended && !is_counting || shown.elapsed() >= SHOWN_EVERY {
                self.show.send_replace(self.source.state());
                shown = Instant::now();
            }
            let until = if is_counting {
                Instant::now()
            } else if ended {
                begun + self.pause
            } else if self.source.is_held() {
                // There is nothing to see but time.
                Instant::now() + SHOWN_EVERY
            } else {
                // The pause is spread over the frame, so that requests meet any part of it.
                begun + self.pause.mul_f64(self.source.part_of_frame())
            };
            if self.answer_until(until).is_err() {
                return;
            }
            if ended {
                begun = Instant::now();
            }
        }
    }

    /// Answers requests until the given time, and then all that are queued.
    fn answer_until(&mut self, until: Instant) -> std::result::Result<(), Disconnected> {
        loop {
            let left = until.saturating_duration_since(Instant::now());
            match self.requests.recv_timeout(left) {
                Ok(asked) => self.answer(asked),
                Err(RecvTimeoutError::Timeout) => return Ok(()),
                Err(RecvTimeoutError::Disconnected) => return Err(Disconnected),
            }
            if !self.source.is_running() {
                return Ok(());
            }
        }
    }

    fn answer(&mut self, Queued { request, answer }: Queued) {
        let waits = matches!(request, Request::Run(RunRequest { frames: Some(_), .. }));
        let reply = self.source.answer(request);
        self.answer_waiting();
        if let Ok(Reply::State(state)) = &reply {
            self.show.send_replace(Arc::clone(state));
        }
        if waits && reply.is_ok() {
            self.waiting = Some(answer);
        } else {
            // A browser that has gone away needs no answer.
            drop(answer.send(reply));
        }
    }

    /// Answers the request that waits for frames, if they have ended.
    fn answer_waiting(&mut self) {
        let Some(outcome) = self.source.take_batch_end() else { return };
        let state = self.source.state();
        self.show.send_replace(Arc::clone(&state));
        if let Some(answer) = self.waiting.take() {
            drop(answer.send(outcome.map(|()| Reply::State(state))));
        }
    }
}

/// Indication that all handles have been dropped.
struct Disconnected;
