//! A run without an end, whose control signals and scene are changed from outside on the way.

use std::sync::Arc;

use crate::error::Result;
use crate::firmware::tof_top::TofTop;
use crate::kernel::Time;
use crate::scenario::Control;
use crate::scenario::window::Window;
use crate::waves::{Marks, Waves};

use super::device::{Device, Off};
use super::frames::{Frame, Frames};
use super::setup::Setup;
use super::shot_recorder::{Shot, ShotRecorder};
use super::sinks::{OptionalRecorder, Sinks, Taker};
use super::stepping::{FastForward, Stepping};
use super::wave_tracer::{WaveTracer, WindowedProbe};

/// Cycles after which shots are handed on at last.
const POLL_INTERVAL: u64 = 1 << 14;

/// What a run has come to.
#[derive(Clone, Debug)]
pub enum Progress {
    /// A frame has ended, of that scene.
    Frame(Frame, Arc<Setup>),
    /// A frame with a shot or more has ended before its depth.
    Abandoned,
    /// Neither.
    Going,
}

/// A run that goes on for as long as it is asked to.
///
/// The same setup and the same changes at the same instants give the same frames, however the time is cut
/// into calls and whichever way it is gone through.
#[derive(Clone)]
pub struct Live {
    setup: Arc<Setup>,
    /// The scene from the next frame on.
    coming: Option<Arc<Setup>>,
    device: Device,
    frames: Frames,
    fast: FastForward,
    recorder: ShotRecorder,
    /// The frame that has ended, until `algo_done` has fallen.
    ended: Option<(Frame, Arc<Setup>)>,
    /// Shots begun by the last begin of a frame.
    shots_before: u64,
    abandoned: u64,
    /// The last change of control.
    changed: Time,
}

impl Live {
    /// At power-up.
    pub fn new(setup: Arc<Setup>, stepping: Stepping) -> Self {
        let mut device = setup.device();
        device.power_up(&mut Off, &mut Off);
        Live {
            fast: FastForward::of(stepping.at_most(&setup)),
            coming: None,
            device,
            frames: Frames::default(),
            recorder: ShotRecorder::default(),
            ended: None,
            shots_before: 0,
            abandoned: 0,
            changed: Time::ZERO,
            setup,
        }
    }

    /// What is in force: the scene of the present frame.
    pub fn setup(&self) -> &Arc<Setup> {
        &self.setup
    }

    /// The device, to look at.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Frames done.
    pub fn done(&self) -> u64 {
        self.frames.done()
    }

    /// Frames that ended before their depth, with a shot or more.
    pub fn abandoned(&self) -> u64 {
        self.abandoned
    }

    /// Shots begun since power-up.
    pub fn shots(&self) -> u64 {
        self.frames.shots()
    }

    /// Shots of the present frame.
    pub fn shots_of_frame(&self) -> u64 {
        self.frames.shots() - self.shots_before
    }

    /// The next edge of `clk_sys`.
    pub fn now(&mut self) -> Time {
        self.device.next_edge()
    }

    /// Changes control signals so long after the coming edge of `clk_sys`, as a scenario's `[[control]]` does; returns
    /// the change with its instant, a whole number of nanoseconds and later than the one before.
    pub fn control(&mut self, change: Control, after: Time) -> Control {
        let earliest = (self.device.next_edge() + after).max(self.changed);
        let at_us = (earliest.fs() / 1_000_000 + 1) as f64 / 1e3;
        let change = Control { at_us, ..change };
        self.repeat(&change);
        change
    }

    /// Whether a change made by [`Live::control`] is still to come.
    pub fn is_changing(&self) -> bool {
        self.device.timeline.next_event() <= self.changed
    }

    /// Makes a change of another run in this one, which has not come to its instant.
    pub fn repeat(&mut self, change: &Control) {
        self.changed = Time::from_ps_f64(change.at_us * 1e6);
        self.device.timeline.insert(self.changed, change.clone());
    }

    /// Whether the present frame is in Clear, before its first shot.
    pub fn is_clearing(&self) -> bool {
        self.device.top.frame_ctrl.clear
    }

    /// Has another scene from the next frame on, or from the present one if that is in Clear; whether the light can
    /// change, which given photons cannot.
    ///
    /// All but the scene (target, air, ambient light) and the control signals at power-up has to be the same. Draws
    /// go on where they are.
    pub fn change_scene(&mut self, setup: Arc<Setup>) -> bool {
        let changes = self.device.light.can_change();
        if changes {
            self.coming = Some(setup);
        }
        if self.is_clearing() {
            self.take_scene();
        }
        changes
    }

    /// Goes on until a frame has ended in whichever way, `probe` is done, or for so many cycles of `clk_sys` or a few more; shows
    /// signals and shots to who wants them.
    ///
    /// # Errors
    /// Those of `probe` and of `shots`.
    pub fn advance<T: WindowedProbe>(
        &mut self,
        cycles: u64,
        probe: &mut T,
        shots: Option<Taker<Shot>>,
    ) -> Result<Progress> {
        let records = shots.is_some();
        let mut sinks = Sinks { shots, frames: None, stop: None };
        if !records {
            return self.go(cycles, probe, &mut Off, &mut sinks);
        }
        let mut recorder = std::mem::take(&mut self.recorder);
        let frame = self.go(cycles, probe, &mut recorder, &mut sinks);
        self.recorder = recorder;
        frame
    }

    /// Goes on to the end of the present frame, and writes windows of it as a waveform; at most for so many cycles.
    ///
    /// # Errors
    /// When the file cannot be written, or a window lies past the end.
    pub fn trace(mut self, waves: Waves, windows: Vec<Window>, cycles: u64) -> Result<Marks> {
        let mut tracer = WaveTracer::new(waves, windows);
        let end = self.device.cycle() + cycles;
        while self.device.cycle() < end {
            let left = end - self.device.cycle();
            if !matches!(self.advance(left, &mut tracer, None)?, Progress::Going) {
                break;
            }
        }
        tracer.finish(self.device.next_edge(), self.frames.shots())
    }

    fn go<T: WindowedProbe, R: OptionalRecorder>(
        &mut self,
        cycles: u64,
        probe: &mut T,
        recorder: &mut R,
        sinks: &mut Sinks,
    ) -> Result<Progress> {
        let end = self.device.cycle() + cycles;
        let mut next_poll = self.device.cycle() + POLL_INTERVAL;
        let mut setup = Arc::clone(&self.setup);
        while self.device.cycle() < end && !probe.is_done() {
            let params = &setup.params;
            if !(T::ON || T::EDGES || R::ON) {
                self.fast.go(&mut self.device, params, &mut self.frames, end);
            }
            if (T::ON || T::EDGES) && probe.is_wanted(&mut self.device, &self.frames, params)? {
                self.device.step(params, probe, recorder);
            } else {
                self.device.step(params, &mut Off, recorder);
            }
            if R::ON {
                recorder.after_edge(&mut self.device, params);
            }
            let top = &self.device.top;
            if let Some(frame) = self.frames.edge(self.device.cycle() - 1, top, params) {
                self.ended = Some((frame, Arc::clone(&setup)));
            }
            let (begins, is_ready) = (begins_frame(top), top.slot.algo_done);
            let abandons = begins && self.begin_frame();
            if begins {
                setup = Arc::clone(&self.setup);
            }
            if !is_ready && let Some((frame, setup)) = self.ended.take() {
                let done = self.frames.done();
                self.device.begin_frame(done);
                recorder.pass_on(sinks)?;
                recorder.begin_frame(done);
                return Ok(Progress::Frame(frame, setup));
            }
            if abandons {
                recorder.pass_on(sinks)?;
                return Ok(Progress::Abandoned);
            }
            if self.device.cycle() >= next_poll {
                next_poll = self.device.cycle() + POLL_INTERVAL;
                recorder.pass_on(sinks)?;
            }
        }
        recorder.pass_on(sinks)?;
        Ok(Progress::Going)
    }

    fn take_scene(&mut self) {
        if let Some(setup) = self.coming.take() {
            self.device.light.change(setup.light_of_row());
            self.fast = FastForward::of(self.fast.stepping);
            self.setup = setup;
        }
    }

    /// A frame begins, with the scene that is to come; whether the one before is abandoned by it.
    #[cold]
    fn begin_frame(&mut self) -> bool {
        self.take_scene();
        let abandons = self.shots_of_frame() > 0 && self.ended.is_none();
        self.abandoned += u64::from(abandons);
        self.shots_before = self.frames.shots();
        abandons
    }
}

/// Whether the edge has begun Clear. While the firmware is held in reset, every edge does.
fn begins_frame(top: &TofTop) -> bool {
    top.frame_ctrl.clear && top.frame_ctrl.clear_addr == 0
}

#[cfg(test)]
mod tests;
