//! Chooses how a run advances: by the plain step, [`Device::step`] for every cycle, or by fast ways that give the
//! same. The only module that the rest of a run knows fast ways by.

use crate::firmware::tof_top::Params;
use crate::scenario::effects::Method;

use super::device::Device;
use super::fast::{Tables, acquire, leap_frame_end, leap_shots, skip_idle};
use super::frames::Frames;
use super::setup::Setup;

/// Simulation fidelity while no observer looks at signals or shots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stepping {
    /// Takes the plain step for every cycle.
    EveryCycle,
    /// Takes no step for cycles that only move hidden counters.
    #[default]
    SkipIdle,
    /// Takes no step for shots of an undisturbed acquisition, for Clear and for an estimation either.
    LeapShots,
}

impl Stepping {
    /// Returns this fidelity, or the plain step where an effect of the scenario invalidates fast ways. What has to hold
    /// from shot to shot they ask of the device.
    pub(super) fn at_most(self, setup: &Setup) -> Self {
        if setup.allows(Method::FastForward) { self } else { Stepping::EveryCycle }
    }
}

/// A simulation fidelity, and the tables that its fast ways keep between two calls.
#[derive(Clone, Debug, Default)]
pub(super) struct FastForward {
    pub(super) stepping: Stepping,
    tables: Tables,
}

impl FastForward {
    /// Fast ways of that fidelity, without tables yet.
    pub(super) fn of(stepping: Stepping) -> Self {
        FastForward { stepping, ..FastForward::default() }
    }

    /// Advances to a cycle that needs the plain step, or to `limit`; a shot, a Clear or an estimation that is leapt
    /// over may end after it [cycles of clk_sys].
    #[inline(always)]
    pub(super) fn go(&mut self, device: &mut Device, p: &Params, frames: &mut Frames, limit: u64) {
        match self.stepping {
            Stepping::EveryCycle => {}
            Stepping::SkipIdle => skip(device, p, frames, limit),
            Stepping::LeapShots => self.leap(device, p, frames, limit),
        }
    }

    #[inline(never)]
    fn leap(&mut self, device: &mut Device, p: &Params, frames: &mut Frames, limit: u64) {
        acquire(device, p, frames, limit, |device, frames, hits| {
            leap_shots(device, p, &mut self.tables, frames, hits);
        });
        skip_idle(device, p, limit);
        leap_frame_end(device, p);
    }
}

// A function of its own, as `leap` is, so that the loop around the plain step keeps its registers.
#[inline(never)]
fn skip(device: &mut Device, p: &Params, frames: &mut Frames, limit: u64) {
    acquire(device, p, frames, limit, |_, _, _| {});
    skip_idle(device, p, limit);
}
