//! Records of shots: the photon, and the TDC's result.

use std::collections::VecDeque;

use crate::error::Result;
use crate::firmware::tof_top::{CodeSource, Params, TofTop};
use crate::kernel::Time;
use crate::optics::hazard::Cause;

use super::callback::Callback;
use super::device::{AvalancheListener, Device, Off};
use super::frames::Frames;
use super::tdc_hits::{ComingAvalanches, LastAvalanches, may_be_of};

/// One shot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shot {
    /// Frame, from 0.
    pub frame: u64,
    /// Shot in the frame, from 0.
    pub shot: u64,
    /// The avalanche that the TDC kept, or else the first one: from the laser edge [fs]. Negative
    /// if it came before (MODE 1).
    pub arrival_fs: Option<i64>,
    /// Its cause; unknown for given photons.
    pub cause: Option<Cause>,
    /// Ones count of the taps.
    pub n: Option<u64>,
    /// Coarse count.
    pub coarse: Option<u64>,
    /// TDC code, which is also the histogram's bin.
    pub code: Option<u64>,
    /// `laser_en` as the driver took it.
    pub laser_en: bool,
    begun: Time,
    cycle: u64,
    has_hit: bool,
    is_decided: bool,
}

/// Follows shots through the TDC's pipeline.
#[derive(Clone, Debug, Default)]
pub(super) struct ShotRecorder {
    /// Shots whose result may still come, oldest first.
    open: VecDeque<Shot>,
    /// Shots that are complete, oldest first.
    complete: Vec<Shot>,
    coming: ComingAvalanches,
    avalanches: LastAvalanches<Option<Cause>>,
    shot: u64,
    /// The driver's `enable`, as the coming shot takes it.
    laser_en: bool,
    last_edge: Time,
    /// `true` if this edge decides on the code of a hit.
    decides: bool,
}

/// Shots that can be open at once.
pub(super) const OPEN: usize = 3;

impl ShotRecorder {
    /// Gives an avalanche to the shot under way.
    fn take(&mut self, at: Time, cause: Option<Cause>) {
        self.avalanches.push(at, cause);
        if let Some(shot) = self.open.back_mut()
            && shot.arrival_fs.is_none()
        {
            (shot.arrival_fs, shot.cause) = (Some(between(shot.begun, at)), cause);
        }
    }

    /// Updates shots from the registers after edge `cycle` at `now`.
    fn edge(&mut self, (cycle, now): (u64, Time), frame: u64, top: &TofTop, p: &Params) {
        while let Some((at, cause)) = self.coming.take_before(now) {
            self.take(at, cause);
        }
        match p.code_source {
            CodeSource::Tdc => self.follow_tdc(cycle, top, p),
            CodeSource::Preload(_) => self.follow_preload(top),
        }
        if top.vcsel_driver.registers.pre_start {
            self.laser_en = top.vcsel_driver.registers.enable;
        }
        if top.vcsel_driver.registers.start {
            let (shot, laser_en) = (self.shot, self.laser_en);
            let begun = Shot { frame, shot, laser_en, begun: now, cycle, ..Shot::default() };
            self.open.push_back(begun);
            self.shot += 1;
            if self.open.len() > OPEN {
                self.complete.extend(self.open.pop_front());
            }
        }
        while let Some((at, cause)) = self.coming.take_at(now) {
            self.take(at, cause);
        }
        if top.frame_ctrl.clear && top.frame_ctrl.clear_addr == 0 {
            self.complete.extend(self.open.drain(..));
            self.shot = 0;
        }
        self.last_edge = now;
    }

    fn follow_tdc(&mut self, cycle: u64, top: &TofTop, p: &Params) {
        let decoder = &top.tdc.tdc_decoder;
        if self.decides
            && let Some(shot) =
                self.open.iter_mut().find(|shot| shot.n.is_some() && !shot.is_decided)
        {
            shot.code = decoder.tdc_valid.then(|| decoder.tdc_code.get());
            shot.is_decided = true;
        }
        self.decides = decoder.decides();
        if let Some((n, coarse)) = decoder.counted()
            && let Some(shot) = self.open.iter_mut().find(|shot| shot.has_hit && shot.n.is_none())
        {
            (shot.n, shot.coarse) = (Some(n), Some(coarse));
        }
        if top.tdc.tdc_latch.hit {
            let avalanche = self.avalanches.of_hit(self.last_edge, p);
            if let Some(shot) = self.open.iter_mut().rfind(|shot| may_be_of(shot.cycle, cycle)) {
                shot.has_hit = true;
                if let Some((at, cause)) = avalanche {
                    (shot.arrival_fs, shot.cause) = (Some(between(shot.begun, at)), cause);
                }
            }
        }
    }

    fn follow_preload(&mut self, top: &TofTop) {
        if top.code_preload.tdc_valid
            && let Some(shot) = self.open.back_mut()
        {
            shot.code = Some(top.code_preload.tdc_code.get());
        }
    }
}

/// An observer of shots: of avalanches, and of the registers after each edge.
pub(super) trait ShotListener: AvalancheListener {
    /// Receives the registers after an edge.
    ///
    /// # Errors
    /// When the callback of a shot fails.
    fn after_edge(&mut self, device: &mut Device, frames: &Frames, p: &Params) -> Result<()>;
}

impl ShotListener for Off {
    #[inline(always)]
    fn after_edge(&mut self, _: &mut Device, _: &Frames, _: &Params) -> Result<()> {
        Ok(())
    }
}

/// Calls back with each shot once its result is known.
pub(super) struct Recording<'a> {
    pub(super) recorder: ShotRecorder,
    pub(super) take: Callback<'a, Shot>,
}

impl<'a> Recording<'a> {
    /// Calls `take` with every shot from power-up on.
    pub(super) fn new(take: Callback<'a, Shot>) -> Self {
        Recording { recorder: ShotRecorder::default(), take }
    }
}

impl AvalancheListener for Recording<'_> {
    const ON: bool = true;

    fn avalanche(&mut self, at: Time, cause: Option<Cause>) {
        self.recorder.coming.push(at, cause);
    }
}

impl ShotListener for Recording<'_> {
    fn after_edge(&mut self, device: &mut Device, frames: &Frames, p: &Params) -> Result<()> {
        self.recorder.edge(device.last_edge(), frames.done(), &device.top, p);
        self.recorder.complete.drain(..).try_for_each(|shot| (self.take)(&shot))
    }
}

/// Returns the time from an instant to another, negative if that came before [fs].
pub(super) fn between(from: Time, to: Time) -> i64 {
    to.fs() as i64 - from.fs() as i64
}
