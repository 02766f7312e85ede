//! Where the pieces of a run go.

use std::sync::atomic::AtomicBool;

use crate::error::Result;
use crate::firmware::tof_top::Params;

use super::device::{AvalancheListener, Device, Off};
use super::frames::Frame;
use super::shot_recorder::{Shot, ShotRecorder};

/// Takes what a run gives, piece by piece; an error ends the run.
pub type Taker<'a, T> = &'a mut dyn FnMut(&T) -> Result<()>;

/// Takers of shots and frames, and who may stop the run.
pub(super) struct Sinks<'a> {
    pub(super) shots: Option<Taker<'a, Shot>>,
    pub(super) frames: Option<Taker<'a, Frame>>,
    pub(super) stop: Option<&'a AtomicBool>,
}

impl Sinks<'_> {
    pub(super) fn frame(&mut self, frame: &Frame) -> Result<()> {
        self.frames.as_mut().map_or(Ok(()), |take| take(frame))
    }
}

/// A recorder, or none.
pub(super) trait OptionalRecorder: AvalancheListener {
    fn after_edge(&mut self, device: &mut Device, p: &Params);
    fn begin_frame(&mut self, frame: u64);
    fn pass_on(&mut self, sinks: &mut Sinks) -> Result<()>;
}

impl OptionalRecorder for Off {
    fn after_edge(&mut self, _: &mut Device, _: &Params) {}
    fn begin_frame(&mut self, _: u64) {}
    fn pass_on(&mut self, _: &mut Sinks) -> Result<()> {
        Ok(())
    }
}

impl OptionalRecorder for ShotRecorder {
    fn after_edge(&mut self, device: &mut Device, p: &Params) {
        let (cycle, now) = device.last_edge();
        self.edge(cycle, now, &device.top, p);
    }
    fn begin_frame(&mut self, frame: u64) {
        self.frame = frame;
    }
    fn pass_on(&mut self, sinks: &mut Sinks) -> Result<()> {
        let take = sinks.shots.as_mut();
        take.map_or(Ok(()), |take| self.complete.drain(..).try_for_each(|shot| take(&shot)))
    }
}
