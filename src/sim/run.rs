//! Runs a device for a number of frames, and hands on what it shows.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::{Error, Input, Result};
use crate::firmware::tof_top::Params;
use crate::kernel::Time;
use crate::waves::{Marks, Waves};

use super::acquisition::Gait;
use super::device::{Device, Off};
use super::frames::{Frame, Frames};
use super::leap::Tables;
use super::recorder::{Recorder, Shot};
use super::setup::Setup;
use super::sinks::{Recorded, Sinks};
use super::tracer::{Tracer, Windowed};
use crate::scenario::window::Window;

/// Cycles between two looks at the world outside.
const BREATH: u64 = 1 << 14;

/// Takes what a run gives, piece by piece; an error ends the run.
pub type Taker<'a, T> = &'a mut dyn FnMut(&T) -> Result<()>;

/// What a run is to do beside simulating.
#[derive(Default)]
pub struct Watch<'a> {
    /// The waveform, and the parts of the run that go into it.
    pub waves: Option<(Waves, Vec<Window>)>,
    /// Takes each shot, in order.
    pub shots: Option<Taker<'a, Shot>>,
    /// Takes each frame, in order.
    pub frames: Option<Taker<'a, Frame>>,
    /// Set from outside to stop the run.
    pub stop: Option<&'a AtomicBool>,
}

/// What a run has come to.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// When it ended.
    pub end: Time,
    /// Edges of `clk_125` simulated.
    pub cycles: u64,
    /// Shots begun.
    pub shots: u64,
    /// Where to look in the waveform.
    pub marks: Marks,
    /// What a user may not expect, a line each.
    pub notes: Vec<String>,
}

/// A run in progress.
#[derive(Clone)]
pub struct Run<'a> {
    pub(super) setup: &'a Setup,
    pub(super) device: Device,
    params: &'a Params,
    pub(super) frames: Frames,
    /// What no run reaches but one that never ends [cycles of clk_125].
    pub(super) limit: u64,
    pub(super) gait: Gait,
    /// When to look at the world outside next [cycles of clk_125].
    pub(super) breath: u64,
    tables: Tables,
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
            gait: Gait::Skip,
            breath: BREATH,
            tables: Tables::default(),
        }
    }

    /// Goes through time at that gait while nobody looks at signals or shots; what comes of it is
    /// the same.
    pub fn at(self, gait: Gait) -> Self {
        Run { gait, ..self }
    }

    /// Simulates until `count` frames are done.
    ///
    /// # Errors
    /// When the control signals keep a frame from ending, a window lies past the end, a sink
    /// fails, or the run is stopped.
    pub fn frames(mut self, count: u64, watch: Watch) -> Result<Outcome> {
        let Watch { waves, shots, frames, stop } = watch;
        let mut sinks = Sinks { shots, frames, stop };
        let mut recorder = sinks.shots.is_some().then(Recorder::default);
        let mut tracer = waves.map(|(waves, windows)| Tracer::new(waves, windows));
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
    pub fn traced<T: Windowed>(
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

    fn power_up<T: Windowed>(&mut self, trace: &mut T) {
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

    pub(super) fn go<T: Windowed, R: Recorded>(
        &mut self,
        count: u64,
        trace: &mut T,
        record: &mut R,
        sinks: &mut Sinks,
    ) -> Result<()> {
        let mut ended = self.frames.done();
        loop {
            if !(T::ON || T::EDGES || R::ON) {
                self.hurry();
            }
            self.cycle(trace, record)?;
            let frame = self.frames.edge(self.device.cycle() - 1, &self.device.top, self.params);
            if let Some(frame) = frame {
                sinks.frame(&frame)?;
            }
            if trace.is_done() {
                return Ok(());
            }
            let done = self.frames.done();
            if done > ended && !self.device.top.socket.algo_done {
                ended = done;
                self.device.light.begin_frame(done);
                record.pass_on(sinks)?;
                record.begin_frame(done);
                if done >= count {
                    return Ok(());
                }
            }
            if self.device.cycle() >= self.breath {
                self.breath = self.device.cycle() + BREATH;
                record.pass_on(sinks)?;
                self.breathe(sinks)?;
            }
        }
    }

    /// Goes where the next cycle is one that has to be stepped.
    #[inline(always)]
    fn hurry(&mut self) {
        let Run { device, frames, params, tables, breath, .. } = self;
        match self.gait {
            Gait::Step => device.acquire::<false>(params, frames, *breath, |_, _| {}),
            Gait::Skip => {
                device.acquire::<true>(params, frames, *breath, |_, _| {});
                device.skip_idle(params, *breath);
            }
            Gait::Leap => {
                device.acquire::<true>(params, frames, *breath, |device, frames| {
                    device.leap_shots(params, tables, frames);
                });
                device.skip_idle(params, *breath);
                device.leap_frame_end(params);
            }
        }
    }

    #[inline(always)]
    fn cycle<T: Windowed, R: Recorded>(&mut self, trace: &mut T, record: &mut R) -> Result<()> {
        if (T::ON || T::EDGES) && trace.is_wanted(&mut self.device, &self.frames, self.params)? {
            self.device.step(self.params, trace, record);
        } else {
            self.device.step(self.params, &mut Off, record);
        }
        if R::ON {
            record.look(&mut self.device, self.params);
        }
        Ok(())
    }

    fn breathe(&self, sinks: &Sinks) -> Result<()> {
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
