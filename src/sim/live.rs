//! A run without an end, whose control signals and scene can be changed on the way.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::error::{Result, poll_stop};
use crate::kernel::Time;
use crate::scenario::Control;
use crate::scenario::window::Window;
use crate::waves::{Marks, Waves};

use super::callback::Callback;
use super::clockwork::{Clockwork, Event};
use super::device::{Device, Off};
use super::frames::Frame;
use super::run::{POLL_INTERVAL, never_ends};
use super::setup::Setup;
use super::shot_recorder::{Recording, Shot, ShotListener, ShotRecorder};
use super::stepping::{FastForward, Stepping};
use super::wave_tracer::{WaveTracer, WindowedProbe};

/// Why [`Live::advance`] has returned.
#[derive(Clone, Debug)]
pub enum Progress {
    /// A frame has ended, of that scene.
    Frame(Frame, Arc<Setup>),
    /// A frame with a shot or more has ended before its depth.
    Abandoned,
    /// Neither.
    Going,
}

/// A run that is advanced for as long as its owner likes.
///
/// The same setup and the same changes at the same instants give the same frames, however the time is cut
/// into calls and at whichever fidelity.
#[derive(Clone)]
pub struct Live {
    setup: Arc<Setup>,
    /// The scene from the next frame on.
    coming: Option<Arc<Setup>>,
    clockwork: Clockwork,
    recorder: ShotRecorder,
    /// Shots begun by the last begin of a frame.
    shots_before: u64,
    abandoned: u64,
    /// The last change of control.
    changed: Time,
}

impl Live {
    /// A run at power-up.
    pub fn new(setup: Arc<Setup>, stepping: Stepping) -> Self {
        let mut device = setup.device();
        device.power_up(&mut Off, &mut Off);
        Live {
            coming: None,
            clockwork: Clockwork::new(device, stepping.at_most(&setup)),
            recorder: ShotRecorder::default(),
            shots_before: 0,
            abandoned: 0,
            changed: Time::ZERO,
            setup,
        }
    }

    /// Returns the setup of the present frame.
    pub fn setup(&self) -> &Arc<Setup> {
        &self.setup
    }

    /// Returns the device, to look at.
    pub fn device(&self) -> &Device {
        &self.clockwork.device
    }

    /// Returns the number of frames done.
    pub fn done(&self) -> u64 {
        self.clockwork.frames.done()
    }

    /// Returns the number of frames that ended before their depth, with a shot or more.
    pub fn abandoned(&self) -> u64 {
        self.abandoned
    }

    /// Returns the number of shots begun since power-up.
    pub fn shots(&self) -> u64 {
        self.clockwork.frames.shots()
    }

    /// Returns the number of shots of the present frame.
    pub fn shots_of_frame(&self) -> u64 {
        self.shots() - self.shots_before
    }

    /// Returns the instant of the next edge of `clk_sys`.
    pub fn now(&mut self) -> Time {
        self.clockwork.device.next_edge()
    }

    /// Changes control signals `after` the next edge of `clk_sys`, as a scenario's `[[control]]` does. Returns the
    /// change with its instant, a whole number of nanoseconds and later than the one before.
    pub fn control(&mut self, change: Control, after: Time) -> Control {
        let earliest = (self.now() + after).max(self.changed);
        let at_us = (earliest.fs() / 1_000_000 + 1) as f64 / 1e3;
        let change = Control { at_us, ..change };
        self.repeat(&change);
        change
    }

    /// Returns whether a change made by [`Live::control`] is still to come.
    pub fn is_changing(&self) -> bool {
        self.clockwork.device.timeline.next_event() <= self.changed
    }

    /// Repeats a change of another run, whose instant this run has not reached.
    pub fn repeat(&mut self, change: &Control) {
        self.changed = Time::from_ps_f64(change.at_us * 1e6);
        self.clockwork.device.timeline.insert(self.changed, change.clone());
    }

    /// Returns whether the present frame is in Clear, before its first shot.
    pub fn is_clearing(&self) -> bool {
        self.clockwork.device.top.frame_ctrl.clear
    }

    /// Changes the scene from the next frame on, or from the present one if that is in Clear. Returns `false` without
    /// a change where photons are given.
    ///
    /// `setup` may differ only in the scene (target, air, ambient light) and in the control signals at power-up.
    /// Random draws continue where they are.
    pub fn change_scene(&mut self, setup: Arc<Setup>) -> bool {
        let changes = self.clockwork.device.light.can_change();
        if changes {
            self.coming = Some(setup);
        }
        if self.is_clearing() {
            self.take_scene();
        }
        changes
    }

    /// Runs until a frame ends or is abandoned, `probe` is done, or at least `cycles` of `clk_sys` have passed; shows
    /// signals to `probe`, and shots to `shots`.
    ///
    /// # Errors
    /// When `probe` or `shots` fails.
    pub fn advance<T: WindowedProbe>(
        &mut self,
        cycles: u64,
        probe: &mut T,
        shots: Option<Callback<Shot>>,
    ) -> Result<Progress> {
        let Some(take) = shots else { return self.go(cycles, probe, &mut Off) };
        let recorder = std::mem::take(&mut self.recorder);
        let mut recording = Recording { recorder, take };
        let progress = self.go(cycles, probe, &mut recording);
        self.recorder = recording.recorder;
        progress
    }

    /// Runs until a frame has ended. A run that is stopped in the middle of a frame goes on from there at the next call.
    ///
    /// # Errors
    /// When the control signals keep the frame from ending, or the run is stopped.
    pub fn next_frame(&mut self, stop: Option<&AtomicBool>) -> Result<Frame> {
        let limit = self.clockwork.cycle() + self.setup.longest_run(1);
        loop {
            if let Progress::Frame(frame, _) = self.advance(POLL_INTERVAL, &mut Off, None)? {
                return Ok(frame);
            }
            poll_stop(stop)?;
            if self.clockwork.cycle() > limit {
                return Err(never_ends(&self.setup, &self.device().top.pins, self.done()));
            }
        }
    }

    /// Runs to the end of the present frame, at most for `cycles`, and writes windows of it as a waveform.
    ///
    /// # Errors
    /// When the file cannot be written, or a window lies past the end.
    pub fn trace(mut self, waves: Waves, windows: Vec<Window>, cycles: u64) -> Result<Marks> {
        let mut tracer = WaveTracer::new(waves, windows);
        let end = self.clockwork.cycle() + cycles;
        while self.clockwork.cycle() < end {
            let left = end - self.clockwork.cycle();
            if !matches!(self.advance(left, &mut tracer, None)?, Progress::Going) {
                break;
            }
        }
        tracer.finish(self.now(), self.shots())
    }

    fn go<T: WindowedProbe, S: ShotListener>(
        &mut self,
        cycles: u64,
        probe: &mut T,
        shots: &mut S,
    ) -> Result<Progress> {
        let end = self.clockwork.cycle() + cycles;
        loop {
            let setup = Arc::clone(&self.setup);
            let event = self.clockwork.advance(&setup.params, end, probe, shots)?;
            if let Event::Paused = event {
                return Ok(Progress::Going);
            }
            let had_shots = self.shots_of_frame() > 0;
            self.shots_before = self.shots();
            self.take_scene();
            if let Event::FrameEnd(frame) = event {
                return Ok(Progress::Frame(frame, setup));
            }
            if had_shots {
                self.abandoned += 1;
                return Ok(Progress::Abandoned);
            }
        }
    }

    fn take_scene(&mut self) {
        if let Some(setup) = self.coming.take() {
            let Clockwork { device, fast, .. } = &mut self.clockwork;
            device.light.change(setup.light_of_row());
            *fast = FastForward::of(fast.stepping);
            self.setup = setup;
        }
    }
}

#[cfg(test)]
mod tests;
