//! Clear and estimation, each as one leap.
//!
//! Exact while no control signal changes and nothing else goes on: a word of the RAM is zero after
//! its cycle of Clear, and an estimation is sums of integers. The TDC's window is closed, so that it sees
//! avalanches on the way with the next edges.

use crate::firmware::depth_estimator::{self, DepthEstimator};
use crate::firmware::estimator_ctrl::EstimatorCtrl;
use crate::firmware::forward1::Forward1;
use crate::firmware::frame_ctrl::State;
use crate::firmware::histogram_builder::Count;
use crate::firmware::tof_top::{Estimator, HistogramSource, Params, TofTop};
use crate::firmware::{centroid_estimator, likelihood_estimator};
use crate::kernel::U;
use crate::network::Histogram;
use crate::network::estimate::estimate;
use crate::sim::device::Device;

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
        && control_is_steady(&device.top)
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
    // The words, and the one at the port while none is read.
    let (words, idle) = match &p.histogram_source {
        HistogramSource::Builder => (&*top.histogram_builder.ram, U::new(0)),
        HistogramSource::Preload(rom) => (&**rom, rom[0]),
    };
    match p.estimator {
        Estimator::Network => {
            let histogram: Histogram = words.iter().map(|word| word.get() as u32).collect();
            land_in_network(&mut top.depth_estimator, &histogram, idle, &p.depth_estimator);
        }
        Estimator::Centroid => {
            let centroid = &mut top.centroid_estimator;
            for _ in 1..p.centroid_estimator.done() {
                let count = words[centroid.registers.read_addr.index()];
                let i = centroid_estimator::In { rst: false, algo_start: false, count };
                centroid.rise(&i, &p.centroid_estimator);
            }
        }
        Estimator::Likelihood => {
            let params = &p.likelihood_estimator;
            let likelihood = &mut top.likelihood_estimator;
            let mode = top.control_sync.mode_sync;
            for _ in 1..params.done() {
                let count = words[likelihood.likelihood_memory.registers.read_addr.index()];
                let i = likelihood_estimator::In { rst: false, algo_start: false, mode, count };
                likelihood.rise(&i, params);
            }
        }
    }
}

/// Lands in the cycle before the depth is ready: the hidden layer's sums at once, and then the plain step.
fn land_in_network(
    network: &mut DepthEstimator,
    words: &[u32],
    idle: Count,
    p: &depth_estimator::Params,
) {
    let ctrl = p.ctrl();
    network.estimator_ctrl = EstimatorCtrl::at(ctrl.tansig(), &ctrl);
    network.forward1 = Forward1::at_rest(estimate(p, words).l1_in, idle, &p.forward1);
    let idle = depth_estimator::In { rst: false, algo_start: false, count: idle };
    for _ in ctrl.tansig() + 1..ctrl.done() {
        network.rise(&idle, p);
    }
}
