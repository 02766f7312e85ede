//! The loop of every run: edges of `clk_sys`, one after another, and the frames that they begin and end.

use crate::error::Result;
use crate::firmware::tof_top::Params;

use super::device::{AvalancheListener, Device, Off, SignalProbe};
use super::frames::{Frame, Frames};
use super::shot_recorder::ShotListener;
use super::stepping::{FastForward, Stepping};
use super::wave_tracer::WindowedProbe;

/// Why [`Clockwork::advance`] has returned.
pub(super) enum Event {
    /// The next frame begins, and this one has ended.
    FrameEnd(Frame),
    /// The frame begins again, after power-up or a reset: there will be no depth of what it was.
    Restart,
    /// The limit has been reached, or the probe is done.
    Paused,
}

/// A device under way, and what its frames have come to.
#[derive(Clone, Debug)]
pub(super) struct Clockwork {
    pub(super) device: Device,
    pub(super) frames: Frames,
    /// The frame whose depth is ready, for the cycle until it ends.
    ready: Option<Frame>,
    pub(super) fast: FastForward,
}

impl Clockwork {
    /// A device at power-up.
    pub(super) fn new(device: Device, stepping: Stepping) -> Self {
        Clockwork {
            device,
            frames: Frames::default(),
            ready: None,
            fast: FastForward::of(stepping),
        }
    }

    /// Returns the number of edges of `clk_sys` so far.
    #[inline(always)]
    pub(super) fn cycle(&self) -> u64 {
        self.device.cycle
    }

    /// Returns the frame whose depth the last edge has made ready.
    pub(super) fn ready(&self) -> Option<&Frame> {
        self.ready.as_ref()
    }

    /// Advances to the next event, by fast ways while neither `probe` nor `shots` looks. A shot, a Clear or an
    /// estimation that is leapt over may end after cycle `limit`.
    ///
    /// # Errors
    /// When `probe` or `shots` fails.
    #[inline(always)]
    pub(super) fn advance<T: WindowedProbe, S: ShotListener>(
        &mut self,
        p: &Params,
        limit: u64,
        probe: &mut T,
        shots: &mut S,
    ) -> Result<Event> {
        while self.device.cycle < limit && !probe.is_done() {
            if !(T::ON || T::EDGES || S::ON) {
                self.fast.go(&mut self.device, p, &mut self.frames, limit);
            }
            let looks =
                (T::ON || T::EDGES) && probe.is_wanted(&mut self.device, &self.frames, p)?;
            let event =
                if looks { self.edge(p, probe, shots) } else { self.edge(p, &mut Off, shots) };
            shots.after_edge(&mut self.device, &self.frames, p)?;
            if let Some(event) = event {
                return Ok(event);
            }
        }
        Ok(Event::Paused)
    }

    /// Takes an edge of `clk_sys` by the plain step; returns whether a frame begins with it.
    #[inline(always)]
    pub(super) fn edge<T: SignalProbe, L: AvalancheListener>(
        &mut self,
        p: &Params,
        probe: &mut T,
        listener: &mut L,
    ) -> Option<Event> {
        self.device.step(p, probe, listener);
        let top = &self.device.top;
        if let Some(frame) = self.frames.edge(self.device.cycle - 1, top, p) {
            self.ready = Some(frame);
        }
        let begins = top.frame_ctrl.clear && top.frame_ctrl.clear_addr == 0;
        begins.then(|| self.begin_frame(listener))
    }

    /// Takes up the random numbers of the next frame, if one has ended.
    #[cold]
    fn begin_frame<L: AvalancheListener>(&mut self, listener: &mut L) -> Event {
        let Some(frame) = self.ready.take() else { return Event::Restart };
        self.device.finish_step(listener);
        self.device.begin_frame(self.frames.done());
        Event::FrameEnd(frame)
    }
}
