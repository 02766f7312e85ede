//! Clear and estimation, each as a whole.
//!
//! Exact while no control signal changes and nothing else goes on: a word of the RAM is zero after
//! its cycle of Clear, and an estimation is sums of integers. The TDC, whose window is closed, sees
//! avalanches on the way with the next edges, and wires and weights follow with the next one.

use crate::firmware::centroid_estimator;
use crate::firmware::depth_estimator::{self, DepthEstimator};
use crate::firmware::estimator_ctrl::{self, EstimatorCtrl};
use crate::firmware::forward1::Forward1;
use crate::firmware::forward2::{Depth, Forward2};
use crate::firmware::frame_ctrl::{LAST_WORD, State};
use crate::firmware::tansig::{self, Tansig};
use crate::firmware::tof_top::{Estimator, HistogramSource, Params, TofTop};
use crate::kernel::{Clocked, U};
use crate::network::Histogram;
use crate::network::estimate::estimate;
use crate::sim::device::Device;

use super::steady::{control_is_steady, estimation_phase, estimator_rests};

/// Leaps to the end of Clear or of an estimation, if one has just begun and nothing else goes on.
#[inline(always)]
pub fn leap_frame_end(device: &mut Device, p: &Params) {
    let ctrl = &device.top.frame_ctrl;
    let clearing = ctrl.state == State::Clear && ctrl.clear_addr == 0;
    let cycles = match clearing {
        true => LAST_WORD,
        false if estimation_phase(&device.top, p) == Some(0) => p.estimator_cycles() - 1,
        false => return,
    };
    let end = device.pll.clk_125.rise(device.cycle + cycles);
    let alone = device.jitter.is_none()
        && control_is_steady(&device.top)
        && (!clearing || estimator_rests(&device.top, p));
    if !alone || end >= device.timeline.next_event() {
        return;
    }
    match clearing {
        true => land_in_clear(&mut device.top, cycles),
        false => land_in_estimation(&mut device.top, p),
    }
    device.cycle += cycles;
}

/// Lands in Clear so many cycles after its first, not past its end.
fn land_in_clear(top: &mut TofTop, cycles: u64) {
    top.histogram_builder.ram[..cycles as usize].fill(U::new(0));
    top.frame_ctrl.clear_addr = U::new(cycles);
}

/// Lands in the cycle before the depth is ready, from the first cycle of an estimation.
fn land_in_estimation(top: &mut TofTop, p: &Params) {
    let words = match &p.histogram_source {
        HistogramSource::Builder => &*top.histogram_builder.ram,
        HistogramSource::Preload(rom) => rom,
    };
    match p.estimator {
        Estimator::Network => {
            let histogram = std::array::from_fn(|bin| words[bin].get() as u16);
            top.depth_estimator = before_done(&histogram, &p.depth_estimator);
        }
        Estimator::Centroid => {
            let centroid = &mut top.centroid_estimator;
            for _ in 1..centroid_estimator::DONE {
                let count = words[centroid.registers.read_addr.index()];
                let i = centroid_estimator::In { rst: false, algo_start: false, count };
                centroid.rise(&i, &p.centroid_estimator);
            }
        }
    }
}

/// The network in the cycle before the depth is ready.
fn before_done(histogram: &Histogram, p: &depth_estimator::Params) -> DepthEstimator {
    let neurons = p.neurons();
    let step = U::new(estimator_ctrl::done(neurons) - 2);
    let estimator_ctrl = EstimatorCtrl { busy: true, step, ..EstimatorCtrl::default() };
    let idle = estimator_ctrl::In { rst: false, algo_start: false };
    let l1_in = estimate(p, histogram).l1_in;
    let l1_out = l1_in.map(|l1_in| p.tansig[tansig::address(l1_in)]);
    let products = l1_out.iter().zip(&p.forward2.w2).map(|(out, w2)| out.get() * w2.get());
    DepthEstimator {
        estimator_ctrl: estimator_ctrl.next(&idle, &neurons),
        forward1: Forward1 { l1_in, ..Forward1::default() },
        tansig: Tansig { l1_out },
        forward2: Forward2 { depth: Depth::new(products.sum()) },
    }
}
