//! Many frames on many cores.
//!
//! Every frame has random streams of its own, and in MODE 0 nothing else of one frame reaches the
//! next but the time: the SPAD is reset before the first shot. So the second frame's begin is found
//! (and the third's, if every other frame is dark), and each of those after it begins there, so many
//! frames later. The results are those of one after the other, and come in that order, whatever the
//! number of threads.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::error::{Error, Result, poll_stop};
use crate::kernel::Time;
use crate::scenario::effects::Method;
use crate::sim::callback::{Callback, call};
use crate::sim::clockwork::Clockwork;
use crate::sim::device::Off;
use crate::sim::frames::Frame;
use crate::sim::run::{Observers, Outcome, Run};
use crate::sim::setup::Setup;
use crate::sim::shot_recorder::Recording;
use crate::sim::stepping::Stepping;
use crate::waves::Marks;

/// Frames that each thread simulates between two deliveries.
const BATCH: u64 = 64;

impl Setup {
    /// Whether each frame gives the same whatever came of the one before, so that it can be simulated by itself.
    pub fn has_separate_frames(&self) -> bool {
        let delays = &self.params.tdc.delays;
        self.allows(Method::SeparateFrames)
            && delays.tap_0() <= self.cycle()
            && delays.longest() <= self.cycle() + self.cycle()
    }
}

impl Run<'_> {
    /// Simulates until `count` frames are done, on all threads of the current pool where frames are
    /// [separate](Setup::has_separate_frames), or else on one. Of `observers`, the shots of the first frame are
    /// shown, every frame in order, and no waveform.
    ///
    /// # Errors
    /// When the control signals keep a frame from ending, a callback fails, or the run is stopped.
    pub fn many(mut self, count: u64, observers: Observers) -> Result<Outcome> {
        let Observers { shots, mut frames, stop, .. } = observers;
        self.limit = self.setup.longest_run(count);
        self.clockwork.device.power_up(&mut Off, &mut Off);
        if let Some(shots) = shots {
            let shown = count.min(self.setup.frames_together());
            self.go(shown, &mut Off, &mut Recording::new(shots), &mut frames, stop)?;
        }
        if !self.setup.has_separate_frames() || rayon::current_num_threads() < 2 || count < 2 {
            if self.done() < count {
                self.go(count, &mut Off, &mut Off, &mut frames, stop)?;
            }
            return Ok(self.outcome(Marks::default()));
        }
        let begins = self.begins(stop)?;
        let begin = |frame: u64| {
            let kind = (frame - begins[0].done()) % begins.len() as u64;
            begins[kind as usize].of_frame(frame)
        };
        deliver(self.done()..count, frames, stop, |frame| {
            let mut run = if frame == 0 { self.clone() } else { begin(frame) };
            run.unobserved_frame(stop)
        })?;
        Ok(begin(count).outcome(Marks::default()))
    }

    /// Returns the run at the begin of a frame after the first, and of the next one if every other frame is dark. They
    /// are found by leaps, because it does not matter what is left of the frames before.
    fn begins(&self, stop: Option<&AtomicBool>) -> Result<Vec<Self>> {
        let next = |run: &Self| -> Result<Self> {
            let mut next = run.clone().stepping(Stepping::LeapShots);
            next.unobserved_frame(stop)?;
            Ok(next.stepping(run.clockwork.fast.stepping))
        };
        let mut begins = vec![if self.done() == 0 { next(self)? } else { self.clone() }];
        while (begins.len() as u64) < self.setup.frames_together() {
            begins.push(next(&begins[begins.len() - 1])?);
        }
        Ok(begins)
    }

    /// Returns the run at the begin of frame `frame`; `self` is at the begin of an earlier one of its kind.
    fn of_frame(&self, frame: u64) -> Self {
        let mut run = self.clone();
        let frames = frame - self.done();
        let cycles = frames * (self.setup.frame_cycles(self.setup.laser_period()) + 1);
        run.clockwork.pass(cycles, frame);
        run.clockwork.frames.shots += self.setup.shots(frames);
        run
    }

    /// Simulates until a frame has ended.
    fn unobserved_frame(&mut self, stop: Option<&AtomicBool>) -> Result<Frame> {
        self.next_frame(&mut Off, &mut Off, stop)?.ok_or(Error::Interrupted)
    }

    fn done(&self) -> u64 {
        self.clockwork.frames.done()
    }
}

impl Clockwork {
    /// Moves from the begin of a frame to that of a later one, so many cycles on, with a detector that has been
    /// quiet for long.
    fn pass(&mut self, cycles: u64, frame: u64) {
        let Clockwork { device, frames, .. } = self;
        let begun = device.pll.clk_sys.rise(device.cycle);
        device.cycle += cycles;
        device.timeline.pass(device.pll.clk_sys.rise(device.cycle) - begun);
        device.begin_frame(frame);
        device.spads.arm_all(Time::NEVER);
        device.rest_stop();
        frames.done = frame;
        frames.clear_at += cycles;
    }
}

/// Makes the frames of a range on all threads, and calls back with each in order.
pub(super) fn deliver(
    range: std::ops::Range<u64>,
    mut frames: Option<Callback<Frame>>,
    stop: Option<&AtomicBool>,
    make: impl Fn(u64) -> Result<Frame> + Sync,
) -> Result<()> {
    let batch = BATCH * rayon::current_num_threads() as u64;
    let mut next = range.start;
    while next < range.end {
        poll_stop(stop)?;
        let end = range.end.min(next + batch);
        let made: Vec<_> = (next..end).into_par_iter().map(&make).collect();
        for frame in made {
            call(&mut frames, &frame?)?;
        }
        next = end;
    }
    Ok(())
}
