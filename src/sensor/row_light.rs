//! Light on the SPADs of a row that each see a part of the scene of their own, as those of an array do.
//!
//! Each SPAD draws its carriers by itself, from its own random streams, so that they are the same whichever of the SPADs
//! a TDC listens to. A carrier that has been drawn and is still to come remains valid when others are consumed,
//! because light on one SPAD is independent of that on another.

use crate::kernel::Time;
use crate::optics::hazard::Cause;

use super::optics::Optics;

/// Light on a row of SPADs.
#[derive(Clone, Debug)]
pub struct RowLight {
    /// Light on each SPAD.
    spads: Vec<Optics>,
    /// Time of each SPAD's next carrier; `None` until it is drawn.
    coming: Vec<Option<Time>>,
    /// SPAD of the carrier that was consumed last.
    last: usize,
}

impl RowLight {
    /// Creates the light on a row from that on each SPAD.
    pub fn new(spads: Vec<Optics>) -> Self {
        RowLight { coming: vec![None; spads.len()], spads, last: 0 }
    }

    /// Returns the number of SPADs.
    pub fn count(&self) -> usize {
        self.spads.len()
    }

    /// Returns the SPAD of the carrier that was consumed last.
    pub fn last(&self) -> usize {
        self.last
    }

    /// Begins a frame.
    #[cold]
    pub(super) fn begin_frame(&mut self, frame: u64) {
        self.spads.iter_mut().for_each(|optics| optics.begin_frame(frame));
    }

    /// Begins a shot at `now`, with or without a laser pulse.
    #[cold]
    pub(super) fn begin_shot(&mut self, now: Time, laser: bool) {
        self.spads.iter_mut().for_each(|optics| optics.begin_shot(now, laser));
        self.coming.fill(None);
    }

    /// Returns the time of the first carrier at or after `now`.
    #[cold]
    pub(super) fn next_avalanche(&mut self, now: Time) -> Time {
        let spads = self.spads.iter_mut().zip(&mut self.coming);
        let next = spads.map(|(optics, coming)| match *coming {
            Some(at) if at >= now => at,
            // One that came while the SPADs were off is lost.
            _ => *coming.insert(optics.next_avalanche(now, 1.0)),
        });
        next.min().unwrap_or(Time::NEVER)
    }

    /// Consumes the carrier at `at`.
    #[cold]
    pub(super) fn take(&mut self, at: Time) {
        if let Some(spad) = self.coming.iter().position(|coming| *coming == Some(at)) {
            self.coming[spad] = None;
            self.spads[spad].take(at);
            self.last = spad;
        }
    }

    /// Returns the fraction of the rate at `at` that is dark counts, in the SPAD of the carrier consumed last [1].
    pub(super) fn dark_part(&self, at: Time) -> f64 {
        self.spads[self.last].dark_part(at)
    }

    /// Draws the cause of the carrier consumed last, at `at`.
    pub(super) fn cause(&mut self, at: Time) -> Cause {
        self.spads[self.last].cause(at, None)
    }

    /// Replaces the hazards by those of another scene.
    pub(super) fn change(&mut self, other: &RowLight) {
        self.spads.iter_mut().zip(&other.spads).for_each(|(own, other)| own.change(other));
    }
}

#[cfg(test)]
mod tests;
