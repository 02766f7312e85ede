//! Conditions under which fast ways are exact.

use crate::firmware::reset_sync::{self, ResetSync};
use crate::firmware::tof_top::{Estimator, Params, TofTop, Wires};
use crate::firmware::{centroid_estimator, depth_estimator, likelihood_estimator};
use crate::kernel::{ASLEEP, Clocked, Time};
use crate::sim::device::Device;

/// Returns whether resets and control signals hold as long as their pins do.
pub(super) fn control_is_steady(top: &TofTop) -> bool {
    let released =
        |reset: &ResetSync, i: &reset_sync::In| !reset.rst_sync && reset.quiet(i, &()) == ASLEEP;
    !top.nets.rst_dsp
        && released(&top.reset_sync_sys, &Wires::reset_sync_sys(top))
        && released(&top.reset_sync_laser, &Wires::reset_sync_laser(top))
        && top.control_sync.quiet(&Wires::control_sync(top), &()) == ASLEEP
}

/// Returns whether no edge changes the estimator until it is started or reset.
pub(super) fn estimator_rests(top: &TofTop, p: &Params) -> bool {
    if estimation_phase(top, p).is_some() {
        return false;
    }
    let (rst, algo_start) = (false, false);
    match p.estimator {
        Estimator::Network => {
            let i = depth_estimator::In { rst, algo_start, ..Wires::depth_estimator(top) };
            top.depth_estimator.rests(&i, &p.depth_estimator)
        }
        Estimator::Centroid => {
            let mut next = top.centroid_estimator;
            let i = centroid_estimator::In { rst, algo_start, ..Wires::centroid_estimator(top) };
            next.rise(&i, &p.centroid_estimator);
            next == top.centroid_estimator
        }
        Estimator::Likelihood => {
            let i =
                likelihood_estimator::In { rst, algo_start, ..Wires::likelihood_estimator(top) };
            top.likelihood_estimator.rests(&i, &p.likelihood_estimator)
        }
    }
}

/// Returns the cycles since the edge that took `algo_start`, while the estimator in the slot works.
pub(super) fn estimation_phase(top: &TofTop, p: &Params) -> Option<u64> {
    match p.estimator {
        Estimator::Network => top.depth_estimator.estimator_ctrl.phase(&p.depth_estimator.ctrl()),
        Estimator::Centroid => top.centroid_estimator.registers.phase(&p.centroid_estimator),
        Estimator::Likelihood => top.likelihood_estimator.begun(),
    }
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
