//! Conditions under which fast ways are exact.

use crate::firmware::reset_sync::{self, ResetSync};
use crate::firmware::tof_top::slot::{SlotEstimator, SlotIn};
use crate::firmware::tof_top::slotted::Slotted;
use crate::firmware::tof_top::{Params, TofTop, Wires};
use crate::in_slot;
use crate::kernel::{ASLEEP, Clocked, Time};
use crate::sim::device::Device;

/// Returns whether resets and control signals hold as long as their pins do.
pub(super) fn control_is_steady(top: &TofTop, p: &Params) -> bool {
    let released =
        |reset: &ResetSync, i: &reset_sync::In| !reset.rst_sync && reset.quiet(i, &()) == ASLEEP;
    !top.nets.rst_dsp
        && released(&top.reset_sync_sys, &Wires::reset_sync_sys(top))
        && released(&top.reset_sync_laser, &Wires::reset_sync_laser(top))
        && top.control_sync.quiet(&Wires::control_sync(top), &p.control_sync()) == ASLEEP
}

/// Returns whether no edge changes the estimator until it is started or reset.
pub(super) fn estimator_rests(top: &TofTop, p: &Params) -> bool {
    estimation_phase(top, p).is_none() && in_slot!(p.estimator, E => rests::<E>(top, p))
}

fn rests<E: Slotted>(top: &TofTop, p: &Params) -> bool {
    let (mode, count) = (top.control_sync.mode_sync, top.nets.count);
    let depth_column = top.frame_ctrl.depth_column;
    let i = SlotIn { rst: false, algo_start: false, mode, depth_column, count };
    E::block(top).rests(&i.into(), E::params(p))
}

/// Returns the cycles since the edge that took `algo_start`, while the estimator in the slot works.
pub(super) fn estimation_phase(top: &TofTop, p: &Params) -> Option<u64> {
    in_slot!(p.estimator, E => E::block(top).phase(E::params(p)))
}

/// Returns the period of `clk_sys`, if no edge jitters.
pub(super) fn even_period(device: &Device) -> Option<Time> {
    device.jitter.is_none().then_some(device.pll.cycle)
}

/// Returns the number of next cycles that end before a control signal changes, or just then.
pub(super) fn cycles_of_steady_control(device: &Device, period: Time) -> u64 {
    let next = device.pll.clk_sys.rise(device.cycle);
    device.timeline.next_event().since(next).fs() / period.fs()
}
