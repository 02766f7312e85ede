//! The run that all browsers see, and the requests that act on it.

mod actions;
mod analyser;
mod awaited;
mod batch;
mod board;
mod causes;
mod clock;
mod image;
mod instrument;
mod reply;
pub mod request;
mod scene;
mod shell;
mod shot;
mod source;
mod strip;
pub mod view;
mod waiting;

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use tofsim::error::{Input, Result};
use tofsim::firmware::tof_top::Pins;
use tofsim::kernel::Time;
use tofsim::scenario::{self, Control, Loaded};
use tofsim::sim::device::Off;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;
use tofsim::sim::{Live, Progress};
use tofsim::{Shot, WaveFormat};

use crate::options::{Fidelity, Options};
use analyser::{Ila, SetUpView, set_ups};
use batch::Batch;
use causes::{Causes, expected};
use clock::Clock;
use instrument::Instrument;
use request::{Request, no_image};
use shot::{Finished, Keyframe};
use strip::Strip;
use view::{FrameView, RateView};

mod file;
mod state;

pub use board::BoardSession;
pub use file::File;
pub use image::ImageSession;
pub use reply::Reply;
pub use source::Source;

/// Largest simulated time of a run, within the range of [`Time`].
const LONGEST: Time = Time::from_ns(8 << 40);

/// The run that all browsers see.
pub struct Session {
    options: Options,
    fidelity: Fidelity,
    /// Scenario as loaded at the start.
    base: Loaded,
    /// Changes of the scene, by key.
    scene: BTreeMap<String, f64>,
    /// Control signals.
    pins: Pins,
    live: Live,
    /// Instrument of the present frame; the next one may differ.
    now: Arc<Instrument>,
    next: Option<Arc<Instrument>>,
    /// Setup at power-up, with all changes of control signals since then.
    origin: Arc<Setup>,
    changes: Vec<Control>,
    exact: bool,
    causes: Causes,
    keyframe: Keyframe,
    finished: Option<Finished>,
    /// Whether a control signal has changed during the present frame.
    mixed: bool,
    frame: Option<FrameView>,
    frame_notes: Vec<String>,
    strip: Strip,
    ila: Ila,
    set_ups: Vec<SetUpView>,
    clock: Clock,
    rates: Vec<RateView>,
    running: bool,
    /// Frames that a request waits for while the run is running.
    batch: Option<Batch>,
    /// Outcome of the last batch, until the request has its answer.
    batch_end: Option<Result<()>>,
    fault: Option<String>,
    version: u64,
}

impl Source for Session {
    fn state(&mut self) -> Arc<str> {
        self.show()
    }

    fn answer(&mut self, request: Request) -> Result<Reply> {
        match request {
            Request::Run(request) => self.run(&request)?,
            Request::Control(request) => self.control(&request)?,
            Request::Scene(asked) => self.change_scene(asked)?,
            Request::Ila(request) => self.arm(&request)?,
            Request::State => {}
            Request::IlaFile(format) => {
                let (name, bytes) = self.ila.file(format)?;
                return Ok(Reply::File(File::of_capture(name, format, bytes)));
            }
            Request::Shot { shot, format, signals } => {
                return Ok(Reply::File(self.waves(shot, format, &signals)?));
            }
            Request::Scenario => return Ok(Reply::File(self.scenario())),
            Request::Image => return Err(no_image()),
        }
        Ok(Reply::State(self.show()))
    }

    fn is_running(&self) -> bool {
        self.running
    }

    fn is_held(&self) -> bool {
        self.held().is_some()
    }

    fn part_of_frame(&self) -> f64 {
        let shots = self.live.setup().shots(1).max(1);
        (self.live.shots_of_frame() as f64 / shots as f64).min(1.0)
    }

    fn advance(&mut self, cycles: u64) -> bool {
        let began = Instant::now();
        let ended = self.step(cycles);
        self.clock.busy += began.elapsed();
        match ended {
            Ok(ended) => {
                self.count(ended);
                ended
            }
            Err(error) => {
                let fault = error.to_string();
                self.end_batch(Err(Input::new("run", &fault).into()));
                self.fault = Some(fault);
                self.stop();
                true
            }
        }
    }

    fn has_batch(&self) -> bool {
        self.batch.is_some()
    }

    fn take_batch_end(&mut self) -> Option<Result<()>> {
        self.batch_end.take()
    }
}

impl Session {
    /// Creates a run at power-up.
    ///
    /// # Errors
    /// If the scenario cannot be run.
    pub fn new(options: Options) -> Result<Self> {
        let base = options.load(&[])?;
        let fidelity = options.fidelity(&base)?;
        let setup = Arc::new(Setup::new(base.clone())?);
        let instrument = Arc::new(Instrument::new(Arc::clone(&setup))?);
        let live = Live::new(Arc::clone(&setup), fidelity.stepping());
        let rate = |&cycles: &u64| RateView {
            cycles,
            mhz: 1e-6 / (cycles as f64 * setup.cycle().seconds()),
        };
        Ok(Session {
            running: !options.stopped,
            scene: BTreeMap::new(),
            pins: live.device().top.pins,
            keyframe: Keyframe::new(&live),
            live,
            now: instrument,
            next: None,
            changes: Vec::new(),
            exact: true,
            causes: Causes::new(setup.params.histogram.bins),
            finished: None,
            mixed: false,
            frame: None,
            frame_notes: Vec::new(),
            strip: Strip::default(),
            ila: Ila::default(),
            set_ups: set_ups(&setup),
            clock: Clock::default(),
            rates: setup.params.vcsel_driver.periods.iter().map(rate).collect(),
            origin: setup,
            batch: None,
            batch_end: None,
            fault: None,
            version: 0,
            base,
            fidelity,
            options,
        })
    }

    fn step(&mut self, cycles: u64) -> Result<bool> {
        if self.live.now() > LONGEST {
            let expected =
                "the run has come to the last instant that can be counted: power up again";
            return Err(Input::new("run", expected).into());
        }
        let causes = &mut self.causes;
        let mut take = |shot: &Shot| {
            causes.add(shot);
            Ok(())
        };
        let shots: Option<tofsim::Callback<Shot>> = match self.fidelity {
            Fidelity::Cycle => Some(&mut take),
            Fidelity::Shot | Fidelity::Histogram => None,
        };
        let progress = if self.ila.is_armed() {
            self.ila.advance(&mut self.live, cycles, shots)?
        } else {
            self.live.advance(cycles, &mut Off, shots)?
        };
        self.ila.take(&self.live, &self.origin, self.exact)?;
        let is_frame = matches!(progress, Progress::Frame(..));
        match progress {
            Progress::Frame(frame, setup) => self.take_frame(&frame, &setup),
            Progress::Abandoned => self.begin_frame(),
            Progress::Going => {}
        }
        Ok(is_frame)
    }

    fn take_frame(&mut self, frame: &Frame, setup: &Arc<Setup>) {
        if let Some(next) = self.next.take_if(|next| Arc::ptr_eq(&next.setup, setup)) {
            self.now = next;
        }
        let now = Arc::clone(&self.now);
        let depths = now.depths(frame);
        let true_m = if frame.laser_en { now.setup.true_depth_m() } else { None };
        let bound = true_m.and(now.bound_two_sd_mm);
        self.strip.push(frame.index, true_m, &depths, bound);
        let notes = now.notes_of(frame);
        self.frame_notes = notes.iter().map(ToString::to_string).collect();
        if self.mixed {
            self.frame_notes.push(
                "note: a control signal changed within the frame: its shots are not alike"
                    .to_owned(),
            );
        }
        let causes_seen = self.fidelity == Fidelity::Cycle;
        let layers = if causes_seen { self.causes.seen(frame) } else { expected(&now, frame) };
        self.frame = Some(FrameView {
            layers,
            causes_seen,
            depths,
            true_m,
            bound_two_sd_mm: bound,
            ..FrameView::of(frame, &now.setup, self.mixed)
        });
        self.clock.frame();
        self.begin_frame();
    }

    fn begin_frame(&mut self) {
        self.causes.clear();
        let next = Keyframe::new(&self.live);
        let last = std::mem::replace(&mut self.keyframe, next);
        self.finished = Some(Finished::new(last, &self.live));
        self.mixed = false;
    }

    fn waves(&self, shot: Option<u64>, format: WaveFormat, signals: &[String]) -> Result<File> {
        let none = || Input::new("shot", "no frame has ended yet");
        let finished = self.finished.as_ref().ok_or_else(none)?;
        Ok(File::of_waves(format, finished.waves(shot, format, signals)?))
    }

    /// Returns the run so far as a scenario.
    fn scenario(&self) -> File {
        let mut scenario = self.origin.scenario.clone();
        scenario.control.extend(self.changes.iter().cloned());
        scenario.control.sort_by(|a, b| a.at_us.total_cmp(&b.at_us));
        File::of_scenario(&self.origin.name, scenario::show::show(&scenario))
    }
}
