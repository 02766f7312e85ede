//! Writes the waveform while a window is open.

use crate::error::{Input, Result};
use crate::firmware::frame_ctrl::{self, FrameCtrl, State as FrameState};
use crate::firmware::tof_top::{Params, TofTop};
use crate::kernel::Time;
use crate::scenario::window::{Moment, Window};
use crate::waves::{Marks, Waves};

use super::device::{Device, Off, SignalProbe};
use super::frames::Frames;

/// A probe that is on only within windows of the run.
pub trait WindowedProbe: SignalProbe {
    /// Begins at power-up if a window includes the time before the first edge of `clk_sys`; returns whether it does.
    fn begins_at_power_up(&mut self, _device: &mut Device) -> bool {
        false
    }
    /// Returns whether to trace the next cycle.
    ///
    /// # Errors
    /// When the trace could not be written.
    fn is_wanted(&mut self, device: &mut Device, frames: &Frames, p: &Params) -> Result<bool>;
    /// Returns whether the run may end here.
    fn is_done(&self) -> bool {
        false
    }
}

impl WindowedProbe for Off {
    fn is_wanted(&mut self, _: &mut Device, _: &Frames, _: &Params) -> Result<bool> {
        Ok(false)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Waiting,
    /// Begins with the coming edge.
    Opening,
    Writing,
}

/// Waveform file that is written while a window is open.
pub(super) struct WaveTracer {
    waves: Waves,
    windows: Vec<Window>,
    state: State,
    marks: Marks,
    /// Shot under way, from three cycles before its laser edge.
    shot: Option<u64>,
    began: Option<Time>,
    /// Windows that the cycle under way belongs to; the viewer first shows what one of them has.
    wanting: usize,
    /// Instant until which that number holds, whatever the device does.
    wanting_until: Time,
}

impl WaveTracer {
    /// A tracer of those windows.
    pub(super) fn new(waves: Waves, windows: Vec<Window>) -> Self {
        let (marks, shot, began) = (Marks::default(), None, None);
        WaveTracer {
            waves,
            windows,
            state: State::Waiting,
            marks,
            shot,
            began,
            wanting: 0,
            wanting_until: Time::ZERO,
        }
    }

    /// Opens a window.
    fn begin(&mut self, now: Time, top: &TofTop) {
        self.state = State::Writing;
        self.waves.begin(now, top);
        self.began.get_or_insert(now);
    }

    fn close(&mut self, now: Time) {
        if self.marks.to == Time::ZERO {
            self.marks.to = now;
        }
        self.waves.end(now);
    }

    fn mark(&mut self, now: Time, top: &TofTop) {
        let marks = &mut self.marks;
        if marks.laser_edge.is_none() && top.nets.laser_on {
            marks.laser_edge = Some(now);
        }
        if marks.spad_edge.is_none() && marks.laser_edge.is_some() && top.pins.tdc_stop {
            marks.spad_edge = Some(now);
        }
        if marks.algo_done.is_none() && top.slot.algo_done {
            marks.algo_done = Some(now);
        }
    }

    fn follow_shot(&mut self, device: &Device, frames: &Frames) {
        let top = &device.top;
        if shot_is_near(top) {
            self.shot = Some(frames.shots());
        } else if top.frame_ctrl.clear {
            self.shot = None;
        }
    }

    /// Puts the waveform in place; `end` and `shots` are the run's.
    pub(super) fn finish(mut self, end: Time, shots: u64) -> Result<Marks> {
        self.waves.check()?;
        for window in &self.windows {
            let fault = |expected| Input::new("--window", expected).value(window);
            window.check(shots, end).map_err(fault)?;
        }
        if self.state == State::Writing {
            self.close(end);
        }
        self.marks.from = self.began.unwrap_or_default();
        self.waves.finish(end)?;
        Ok(self.marks)
    }
}

impl SignalProbe for WaveTracer {
    const ON: bool = true;

    fn sample(&mut self, now: Time, top: &TofTop) {
        match self.state {
            State::Opening if top.clocks.clk_sys => self.begin(now, top),
            State::Writing => self.waves.sample(now, top),
            State::Opening | State::Waiting => return,
        }
        self.mark(now, top);
    }

    fn outputs(&mut self, outputs: u64) {
        self.waves.outputs(outputs);
    }

    #[inline]
    fn tick(&mut self, now: Time, top: &TofTop) {
        if self.state == State::Writing {
            self.waves.tick(now, top);
        }
    }
}

impl WindowedProbe for WaveTracer {
    fn begins_at_power_up(&mut self, device: &mut Device) -> bool {
        let cycle = (Time::ZERO, device.next_edge());
        let moment = Moment { cycle, shot: None, estimating: false };
        let begins = self.windows.iter().any(|window| window.wants(&moment));
        if begins {
            device.resume_clocks(Time::ZERO);
            self.begin(Time::ZERO, &device.top);
        }
        begins
    }

    fn is_wanted(&mut self, device: &mut Device, frames: &Frames, p: &Params) -> Result<bool> {
        self.waves.check()?;
        let cycle = device.coming_cycle();
        if cycle.1 <= self.wanting_until {
            return Ok(self.wanting > 0);
        }
        self.follow_shot(device, frames);
        let estimating = is_estimating(&device.top.frame_ctrl, &p.frame_ctrl);
        let moment = Moment { cycle, shot: self.shot, estimating };
        let wanting = self.windows.iter().filter(|window| window.wants(&moment)).count();
        let wanted = wanting > 0;
        let changes = self.wanting > 0 && wanting != self.wanting;
        if self.state == State::Writing && changes && self.marks.to == Time::ZERO {
            self.marks.to = cycle.0;
        }
        self.wanting = wanting;
        let held = self.windows.iter().map(|window| window.holds_until(cycle.0));
        self.wanting_until = held.min().unwrap_or(Time::ZERO);
        match (self.state, wanted) {
            (State::Waiting, true) => {
                self.state = State::Opening;
                device.resume_clocks(cycle.0);
            }
            (State::Writing, false) => {
                self.state = State::Waiting;
                self.close(cycle.0);
            }
            _ => {}
        }
        Ok(wanted)
    }
}

/// Returns whether a shot begins in four cycles: two before `pre_start` rises.
fn shot_is_near(top: &TofTop) -> bool {
    let laser = &top.vcsel_driver.registers;
    top.frame_ctrl.acquire && laser.count + 3 == laser.last
}

/// Returns whether the estimator works, is about to, or has just finished.
fn is_estimating(ctrl: &FrameCtrl, p: &frame_ctrl::Params) -> bool {
    const NEAR: u64 = 2;
    match ctrl.state {
        FrameState::Clear if ctrl.frame_done => true,
        FrameState::Clear => p.preloaded && ctrl.clear_addr.get() + NEAR >= p.histogram.last_bin(),
        FrameState::Acquire => false,
        FrameState::Drain => ctrl.drain.get() + NEAR >= p.last_drain(),
        FrameState::Estimate => true,
    }
}
