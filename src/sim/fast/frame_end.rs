//! Clear and estimation, each as one leap.
//!
//! Exact while no control signal changes and nothing else goes on: a word of the RAM is zero after
//! its cycle of Clear, and an estimation is sums of integers. The TDC's window is closed, so that it sees
//! avalanches on the way with the next edges.

use crate::firmware::frame_ctrl::State;
use crate::firmware::tof_top::slotted::Slotted;
use crate::firmware::tof_top::{HistogramSource, Params, TofTop};
use crate::in_slot;
use crate::kernel::U;
use crate::sim::device::Device;
use crate::sim::estimates::Clockless;

use super::steady::{control_is_steady, estimation_phase, estimator_rests};

/// Leaps to the end of Clear, or of an estimation that has just begun, if nothing else goes on.
#[inline(always)]
pub fn leap_frame_end(device: &mut Device, p: &Params) {
    let ctrl = &device.top.frame_ctrl;
    let last_bin = p.histogram.last_bin();
    let clearing = ctrl.state == State::Clear && ctrl.clear_addr != last_bin;
    let cycles = if clearing {
        last_bin - ctrl.clear_addr.get()
    } else if estimation_phase(&device.top, p) == Some(0) {
        p.estimator_cycles() - 1
    } else {
        return;
    };
    let end = device.pll.clk_sys.rise(device.cycle + cycles);
    let alone = device.jitter.is_none()
        && control_is_steady(&device.top, p)
        && !device.top.tdc.coarse_counter.window
        && !device.top.histogram_builder.has_hit()
        && (!clearing || estimator_rests(&device.top, p));
    if !alone || end >= device.timeline.next_event() {
        return;
    }
    if clearing {
        land_in_clear(&mut device.top, last_bin);
    } else {
        land_in_estimation(&mut device.top, p);
    }
    device.top.settle(p);
    device.cycle += cycles;
}

/// Lands in the last cycle of Clear.
fn land_in_clear(top: &mut TofTop, last_bin: u64) {
    let from = top.frame_ctrl.clear_addr.index();
    top.histogram_builder.ram[from..last_bin as usize].fill(U::new(0));
    top.frame_ctrl.clear_addr = U::new(last_bin);
}

/// Lands in the cycle before the depth is ready, from the first cycle of an estimation.
fn land_in_estimation(top: &mut TofTop, p: &Params) {
    let mode = top.control_sync.mode_sync;
    in_slot!(p.estimator, E => {
        let mut block = std::mem::take(E::block_mut(top));
        // The words, and the one at the port while none is read.
        let (words, idle) = match &p.histogram_source {
            HistogramSource::Builder => (&*top.histogram_builder.ram, U::new(0)),
            HistogramSource::Preload(rom) => (&**rom, rom[0]),
        };
        block.land(words, idle, mode, E::params(p));
        *E::block_mut(top) = block;
    });
}
