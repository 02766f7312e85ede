//! Ways through time that are not the plain step, [`Device::step`], and come to the same.
//!
//! Each says when it is exact and is compared with the plain step in `tests/`. They work on the
//! registers as anybody sees them; no block of the firmware knows of them.

mod acquisition;
pub mod centroid;
mod draws;
mod frame_end;
mod halves;
pub mod histogram;
mod hits;
mod idle;
pub mod likelihood;
mod many;
mod outcomes;
mod pulse;
mod shots;
mod steady;

use crate::firmware::tof_top::Params;

use super::device::Device;
use super::frames::Frames;
use super::setup::Setup;

pub use acquisition::acquire;
pub use frame_end::leap_frame_end;
pub use idle::skip_idle;
pub use outcomes::{NO_CODE, NO_HIT, ShotOutcome, ShotOutcomes};
pub use shots::{Tables, leap_shots};

/// How a run goes through time where nobody looks at signals or shots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stepping {
    /// The plain step for every cycle.
    EveryCycle,
    /// No step for what would only move hidden counters.
    #[default]
    SkipIdle,
    /// Nor for shots of an undisturbed acquisition, for Clear and for an estimation.
    LeapShots,
}

impl Stepping {
    /// That way, or the plain step where the firmware calibrates itself, its chain is another at each edge, or pulses
    /// are shaped: the others know nothing of ring, disturbance, and pulses that end by themselves.
    pub(super) fn at_most(self, setup: &Setup) -> Self {
        let is_plain = setup.params.tdc_calibration.is_some()
            || setup.disturbance().is_some()
            || setup.scenario.spad.shaping().next().is_some();
        if is_plain { Stepping::EveryCycle } else { self }
    }
}

/// A way through time, and what it keeps between two calls.
#[derive(Clone, Debug, Default)]
pub(super) struct FastForward {
    pub(super) stepping: Stepping,
    tables: Tables,
}

impl FastForward {
    /// That way, with nothing kept yet.
    pub(super) fn of(stepping: Stepping) -> Self {
        FastForward { stepping, ..FastForward::default() }
    }

    /// Goes on, by `limit` at the latest but for a shot, a Clear or an estimation that is leapt over, to
    /// where the plain step has to take the next cycle [cycles of clk_sys].
    #[inline(always)]
    pub(super) fn go(&mut self, device: &mut Device, p: &Params, frames: &mut Frames, limit: u64) {
        match self.stepping {
            Stepping::EveryCycle => {}
            Stepping::SkipIdle => {
                acquire(device, p, frames, limit, |_, _, _| {});
                skip_idle(device, p, limit);
            }
            Stepping::LeapShots => {
                acquire(device, p, frames, limit, |device, frames, hits| {
                    leap_shots(device, p, &mut self.tables, frames, hits);
                });
                skip_idle(device, p, limit);
                leap_frame_end(device, p);
            }
        }
    }
}
