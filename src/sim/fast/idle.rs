//! Idle cycles, skipped as a whole.
//!
//! Exact while every module is quiet, no pin changes and the detector does nothing: nothing would move
//! but counters whose values no other module acts on, and [`Clocked::skip`] moves those.

use crate::firmware::tof_top::{Params, Wires};
use crate::kernel::{AWAKE, Clocked, Time};
use crate::sim::device::Device;

use super::halves::{converter_quiet, emitter_quiet, skip_converter, skip_emitter};
use super::steady::{cycles_of_steady_control, estimator_rests, even_period};

/// Skips the cycles before the next one in which something may happen, up to `limit` [cycles of
/// clk_sys].
#[inline(always)]
pub fn skip_idle(device: &mut Device, p: &Params, limit: u64) {
    let Some(period) = even_period(device) else { return };
    let quiet = quiet(device, p);
    let cycles =
        quiet.min(cycles_of_steady_control(device, period)).min(limit.saturating_sub(device.cycle));
    if cycles != AWAKE {
        let now = device.pll.clk_sys.rise(device.cycle);
        let cycles = cycles_until_event(device, cycles, now, period);
        let top = &mut device.top;
        top.frame_ctrl.skip(&Wires::frame_ctrl(top), &p.frame_ctrl, cycles);
        skip_emitter(top, p, cycles);
        skip_converter(top, p, cycles);
        device.cycle += cycles;
    }
}

/// Returns how many of `quiet` cycles, the first of them at `now`, have their edge of `clk_sys` before the detector's
/// next event.
#[inline(always)]
pub(super) fn cycles_until_event(device: &Device, quiet: u64, now: Time, period: Time) -> u64 {
    let event = device.spads.next_event();
    if event < now.saturating_add(Time::from_fs(quiet * period.fs())) {
        event.since(now).fs().div_ceil(period.fs())
    } else {
        quiet
    }
}

/// Returns the number of next cycles in which only hidden counters move, while all pins hold.
fn quiet(device: &Device, p: &Params) -> u64 {
    let top = &device.top;
    let frame_ctrl = top.frame_ctrl.quiet(&Wires::frame_ctrl(top), &p.frame_ctrl);
    if frame_ctrl == AWAKE || top.nets.rst_dsp {
        return AWAKE;
    }
    let quiet = frame_ctrl
        .min(top.reset_sync_sys.quiet(&Wires::reset_sync_sys(top), &()))
        .min(top.reset_sync_laser.quiet(&Wires::reset_sync_laser(top), &()))
        .min(top.control_sync.quiet(&Wires::control_sync(top), &p.control_sync()))
        .min(emitter_quiet(top, p))
        .min(converter_quiet(device, p));
    if quiet != AWAKE && estimator_rests(top, p) { quiet } else { AWAKE }
}
