//! Runs a device for a number of frames, and hands on what it shows.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::{Error, Input, Result};
use crate::firmware::tof_top::Params;
use crate::kernel::Time;
use crate::note::Note;
use crate::scenario::window::Window;
use crate::waves::{Marks, Waves};

use super::device::{Device, Off};
use super::frames::{Frame, Frames};
use super::setup::Setup;
use super::shot_recorder::{Shot, ShotRecorder};
use super::sinks::{OptionalRecorder, Sinks, Taker};
use super::stepping::{FastForward, Stepping};
use super::wave_tracer::{WaveTracer, WindowedProbe};

/// Cycles between two looks at whether to stop.
const POLL_INTERVAL: u64 = 1 << 14;
/// Cycles that a fast way takes at most between two of them: a part of a second.
const FAST_INTERVAL: u64 = 1 << 20;

/// Observers of a run, and the flag that stops it.
#[derive(Default)]
pub struct Observers<'a> {
    /// The waveform, and the parts of the run that go into it.
    pub waves: Option<(Waves, Vec<Window>)>,
    /// Takes each shot, in order.
    pub shots: Option<Taker<'a, Shot>>,
    /// Takes each frame, in order.
    pub frames: Option<Taker<'a, Frame>>,
    /// Set from outside to stop the run.
    pub stop: Option<&'a AtomicBool>,
}

/// Result of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// When it ended.
    pub end: Time,
    /// Edges of `clk_sys` simulated.
    pub cycles: u64,
    /// Shots begun.
    pub shots: u64,
    /// Where to look in the waveform.
    pub marks: Marks,
    /// What of its inputs the run did not come to.
    pub notes: Vec<Note>,
}

/// A run in progress.
#[derive(Clone)]
pub struct Run<'a> {
    pub(super) setup: &'a Setup,
    pub(super) device: Device,
    params: &'a Params,
    pub(super) frames: Frames,
    /// What no run reaches but one that never ends [cycles of clk_sys].
    pub(super) limit: u64,
    pub(super) fast: FastForward,
    /// When to look at whether to stop next [cycles of clk_sys].
    pub(super) next_poll: u64,
}

impl<'a> Run<'a> {
    /// A run of `setup` from power-up, which skips idle cycles where nobody looks at them.
    pub fn new(setup: &'a Setup) -> Self {
        Run {
            setup,
            device: setup.device(),
            params: &setup.params,
            frames: Frames::default(),
            limit: 0,
            fast: FastForward::of(Stepping::default().at_most(setup)),
            next_poll: POLL_INTERVAL,
        }
    }

    /// Goes through time that way while nobody looks at signals or shots; what comes of it is the
    /// same.
    pub fn stepping(mut self, stepping: Stepping) -> Self {
        self.fast.stepping = stepping.at_most(self.setup);
        self
    }

    /// Simulates `count` frames and returns them.
    ///
    /// # Errors
    /// When the control signals keep a frame from ending.
    pub fn frames(self, count: u64) -> Result<Vec<Frame>> {
        let mut frames = Vec::new();
        let mut take = |frame: &Frame| {
            frames.push(frame.clone());
            Ok(())
        };
        self.observe(count, Observers { frames: Some(&mut take), ..Observers::default() })?;
        Ok(frames)
    }

    /// Simulates until `count` frames are done, and shows the observers what they ask for.
    ///
    /// # Errors
    /// When the control signals keep a frame from ending, a window lies past the end, an observer
    /// fails, or the run is stopped.
    pub fn observe(mut self, count: u64, observers: Observers) -> Result<Outcome> {
        let Observers { waves, shots, frames, stop } = observers;
        let mut sinks = Sinks { shots, frames, stop };
        let mut recorder = sinks.shots.is_some().then(ShotRecorder::default);
        let mut tracer = waves.map(|(waves, windows)| WaveTracer::new(waves, windows));
        self.limit = self.setup.longest_run(count);

        match &mut tracer {
            Some(tracer) => self.power_up(tracer),
            None => self.power_up(&mut Off),
        }
        match (&mut tracer, &mut recorder) {
            (None, None) => self.go(count, &mut Off, &mut Off, &mut sinks)?,
            (None, Some(recorder)) => self.go(count, &mut Off, recorder, &mut sinks)?,
            (Some(tracer), None) => self.go(count, tracer, &mut Off, &mut sinks)?,
            (Some(tracer), Some(recorder)) => self.go(count, tracer, recorder, &mut sinks)?,
        }
        let (end, shots) = (self.device.next_edge(), self.frames.shots());
        let marks = tracer.map_or(Ok(Marks::default()), |tracer| tracer.finish(end, shots))?;
        Ok(self.outcome(marks))
    }

    /// Simulates until `count` frames are done, or until `trace` is; it sees the signals whenever it
    /// wants to.
    ///
    /// # Errors
    /// When the control signals keep a frame from ending, `trace` fails, or the run is stopped.
    #[doc(hidden)]
    pub fn traced<T: WindowedProbe>(
        mut self,
        count: u64,
        trace: &mut T,
        stop: Option<&AtomicBool>,
    ) -> Result<Outcome> {
        let mut sinks = Sinks { shots: None, frames: None, stop };
        self.limit = self.setup.longest_run(count);
        self.power_up(trace);
        self.go(count, trace, &mut Off, &mut sinks)?;
        Ok(self.outcome(Marks::default()))
    }

    fn power_up<T: WindowedProbe>(&mut self, trace: &mut T) {
        if trace.begins_at_power_up(&mut self.device) {
            self.device.power_up(trace, &mut Off);
        } else {
            self.device.power_up(&mut Off, &mut Off);
        }
    }

    pub(super) fn outcome(mut self, marks: Marks) -> Outcome {
        let (end, cycles, shots) =
            (self.device.next_edge(), self.device.cycle(), self.frames.shots());
        Outcome { end, cycles, shots, marks, notes: self.device.unused() }
    }

    pub(super) fn go<T: WindowedProbe, R: OptionalRecorder>(
        &mut self,
        count: u64,
        probe: &mut T,
        recorder: &mut R,
        sinks: &mut Sinks,
    ) -> Result<()> {
        let mut ended = self.frames.done();
        loop {
            if !(T::ON || T::EDGES || R::ON) {
                let Run { device, frames, params, fast, .. } = self;
                fast.go(device, params, frames, device.cycle() + FAST_INTERVAL);
            }
            self.cycle(probe, recorder)?;
            let frame = self.frames.edge(self.device.cycle() - 1, &self.device.top, self.params);
            if let Some(frame) = frame {
                sinks.frame(&frame)?;
            }
            if probe.is_done() {
                return Ok(());
            }
            let done = self.frames.done();
            if done > ended && !self.device.top.socket.algo_done {
                ended = done;
                self.device.begin_frame(done);
                recorder.pass_on(sinks)?;
                recorder.begin_frame(done);
                if done >= count {
                    return Ok(());
                }
            }
            if self.device.cycle() >= self.next_poll {
                self.next_poll = self.device.cycle() + POLL_INTERVAL;
                recorder.pass_on(sinks)?;
                self.poll_stop(sinks)?;
            }
        }
    }

    #[inline(always)]
    fn cycle<T: WindowedProbe, R: OptionalRecorder>(
        &mut self,
        probe: &mut T,
        recorder: &mut R,
    ) -> Result<()> {
        if (T::ON || T::EDGES) && probe.is_wanted(&mut self.device, &self.frames, self.params)? {
            self.device.step(self.params, probe, recorder);
        } else {
            self.device.step(self.params, &mut Off, recorder);
        }
        if R::ON {
            recorder.after_edge(&mut self.device, self.params);
        }
        Ok(())
    }

    fn poll_stop(&self, sinks: &Sinks) -> Result<()> {
        if sinks.stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
            return Err(Error::Interrupted);
        }
        if self.device.cycle() > self.limit {
            return Err(self.stuck());
        }
        Ok(())
    }
}

impl Run<'_> {
    /// That the control signals keep a frame from ending, and which.
    fn stuck(&self) -> Error {
        let pins = &self.device.top.pins;
        let (pin, held) = match (pins.rst, pins.dsp_rst, pins.dsp_en) {
            (true, ..) => ("rst", "stays high"),
            (_, true, _) => ("dsp_rst", "stays high"),
            (.., false) => ("dsp_en", "stays low"),
            _ => ("control", "begins it again and again"),
        };
        let changes = self.setup.scenario.control.iter().rposition(|change| match pin {
            "rst" => change.rst.is_some(),
            "dsp_rst" => change.dsp_rst.is_some(),
            _ => change.dsp_en.is_some(),
        });
        let field = match changes {
            Some(last) => format!("control.{last}.{pin}"),
            None => format!("firmware.{pin}"),
        };
        let expected = format!("frame {} never ends: {pin} {held}", self.frames.done());
        Input::new(format!("scenario {}", self.setup.name), expected).field(field).into()
    }
}
