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

/// A cycle that is to come.
pub(super) struct Turn {
    /// Whether a window has it.
    wanted: bool,
    /// Whether a window has it, and none has the one before.
    opens: bool,
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
    pub(super) fn begin(&mut self, now: Time, top: &TofTop) {
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

    fn follow_shot(&mut self, top: &TofTop, shots: u64) {
        if shot_is_near(top) {
            self.shot = Some(shots);
        } else if top.frame_ctrl.clear {
            self.shot = None;
        }
    }

    /// Returns whether a window has the time from power-up to the first edge of `clk_sys`.
    pub(super) fn wants_power_up(&self, first_edge: Time) -> bool {
        let moment = Moment { cycle: (Time::ZERO, first_edge), shot: None, estimating: false };
        self.windows.iter().any(|window| window.wants(&moment))
    }

    /// Takes the coming cycle, after so many shots of the run; returns whether a window has it, and whether it is the
    /// first of those.
    ///
    /// # Errors
    /// When the waveform could not be written.
    #[inline(always)]
    pub(super) fn turn(
        &mut self,
        cycle: (Time, Time),
        top: &TofTop,
        shots: u64,
        p: &frame_ctrl::Params,
    ) -> Result<Turn> {
        self.waves.check()?;
        if cycle.1 <= self.wanting_until {
            return Ok(Turn { wanted: self.wanting > 0, opens: false });
        }
        Ok(self.look_at_windows(cycle, top, shots, p))
    }

    /// Takes a cycle for which the windows have not decided yet.
    #[inline(never)]
    fn look_at_windows(
        &mut self,
        cycle: (Time, Time),
        top: &TofTop,
        shots: u64,
        p: &frame_ctrl::Params,
    ) -> Turn {
        self.follow_shot(top, shots);
        let estimating = is_estimating(&top.frame_ctrl, p);
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
        let opens = self.state == State::Waiting && wanted;
        match (self.state, wanted) {
            (State::Waiting, true) => self.state = State::Opening,
            (State::Writing, false) => {
                self.state = State::Waiting;
                self.close(cycle.0);
            }
            _ => {}
        }
        Turn { wanted, opens }
    }

    /// Returns whether no window has the cycle that begins at `now` or a later one.
    pub(super) fn is_over(&self, now: Time) -> bool {
        self.windows.iter().all(|window| match *window {
            Window::Shots { to, .. } => self.shot.is_some_and(|shot| shot >= to),
            Window::Span { to, .. } => to <= now,
            Window::Estimation => false,
        })
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
        let begins = self.wants_power_up(device.next_edge());
        if begins {
            device.resume_clocks(Time::ZERO);
            self.begin(Time::ZERO, &device.top);
        }
        begins
    }

    fn is_wanted(&mut self, device: &mut Device, frames: &Frames, p: &Params) -> Result<bool> {
        let cycle = device.coming_cycle();
        let turn = self.turn(cycle, &device.top, frames.shots(), &p.frame_ctrl)?;
        if turn.opens {
            device.resume_clocks(cycle.0);
        }
        Ok(turn.wanted)
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
    if ctrl.frame_done || ctrl.is_estimating() {
        return true;
    }
    match ctrl.state {
        FrameState::Clear => p.preloaded && ctrl.clear_addr.get() + NEAR >= p.histogram.last_bin(),
        FrameState::Acquire => false,
        FrameState::Drain => ctrl.drain.get() + NEAR >= p.last_drain(),
        FrameState::Estimate => true,
    }
}
