//! The thread that simulates, and how the others ask it for something.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use tokio::sync::{oneshot, watch};

use tofsim::error::{Error, Input, Result};

use crate::options::Options;
use crate::session::request::Request;
use crate::session::{Reply, Session};

/// Requests that may wait.
const WAITING: usize = 64;
/// Cycles between two looks at requests: a millisecond.
const CYCLES: u64 = 1 << 14;
/// The longest time between two states of a frame that takes long.
const SHOWN_EVERY: Duration = Duration::from_millis(100);

/// A request, and where its answer goes.
struct Asked {
    request: Request,
    answer: oneshot::Sender<Result<Reply>>,
}

/// What asks the thread that simulates.
#[derive(Clone)]
pub struct Engine {
    asked: SyncSender<Asked>,
    states: watch::Receiver<Arc<str>>,
}

/// Why there is no answer.
#[derive(Debug)]
pub enum NoAnswer {
    /// Too many requests wait.
    Busy,
    /// The request is wrong, or nothing can be done about it.
    Refused(Error),
    /// The thread has ended.
    Gone,
}

impl Engine {
    /// Begins a run at power-up.
    ///
    /// # Errors
    /// When the scenario cannot be run.
    pub fn start(options: Options) -> Result<Self> {
        let pause = Duration::from_secs(1) / options.rate;
        let mut session = Session::new(options)?;
        let (show, states) = watch::channel(session.state());
        let (asked, requests) = sync_channel(WAITING);
        let run = move || Thread { session, requests, show, pause }.run();
        let thread = thread::Builder::new().name("simulation".to_owned()).spawn(run);
        thread.map_err(|error| Input::new("simulation", error))?;
        Ok(Engine { asked, states })
    }

    /// Asks for something, and waits for the answer.
    ///
    /// # Errors
    /// Why there is none.
    pub async fn ask(&self, request: Request) -> std::result::Result<Reply, NoAnswer> {
        let (answer, answered) = oneshot::channel();
        self.asked.try_send(Asked { request, answer }).map_err(|error| match error {
            TrySendError::Full(_) => NoAnswer::Busy,
            TrySendError::Disconnected(_) => NoAnswer::Gone,
        })?;
        answered.await.map_err(|_| NoAnswer::Gone)?.map_err(NoAnswer::Refused)
    }

    /// The states to come; who is slow misses some, and the newest is always there.
    pub fn states(&self) -> watch::Receiver<Arc<str>> {
        self.states.clone()
    }
}

/// The thread that simulates.
struct Thread {
    session: Session,
    requests: Receiver<Asked>,
    show: watch::Sender<Arc<str>>,
    /// From the begin of a frame to that of the next one at least.
    pause: Duration,
}

impl Thread {
    /// Until nobody can ask any more.
    fn run(mut self) {
        let (mut begun, mut shown) = (Instant::now(), Instant::now());
        loop {
            if !self.session.is_running() {
                let Ok(asked) = self.requests.recv() else { return };
                self.answer(asked);
                begun = Instant::now();
                continue;
            }
            let ended = self.session.advance(CYCLES);
            if ended || shown.elapsed() >= SHOWN_EVERY {
                self.show.send_replace(self.session.state());
                shown = Instant::now();
            }
            // The pause is spread over the frame, so that requests meet any part of it.
            let until = match (ended, self.session.is_held()) {
                (true, _) => begun + self.pause,
                // There is nothing to see but time.
                (false, true) => Instant::now() + SHOWN_EVERY,
                (false, false) => begun + self.pause.mul_f64(self.session.part_of_frame()),
            };
            if self.answer_until(until).is_err() {
                return;
            }
            if ended {
                begun = Instant::now();
            }
        }
    }

    /// Answers until then, and all that wait.
    fn answer_until(&mut self, until: Instant) -> std::result::Result<(), Gone> {
        loop {
            let left = until.saturating_duration_since(Instant::now());
            match self.requests.recv_timeout(left) {
                Ok(asked) => self.answer(asked),
                Err(RecvTimeoutError::Timeout) => return Ok(()),
                Err(RecvTimeoutError::Disconnected) => return Err(Gone),
            }
            if !self.session.is_running() {
                return Ok(());
            }
        }
    }

    fn answer(&mut self, Asked { request, answer }: Asked) {
        let reply = self.session.answer(request);
        if let Ok(Reply::State(state)) = &reply {
            self.show.send_replace(Arc::clone(state));
        }
        // A browser that has gone away needs no answer.
        drop(answer.send(reply));
    }
}

/// Nobody can ask any more.
struct Gone;
