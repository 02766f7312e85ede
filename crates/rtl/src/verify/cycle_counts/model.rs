//! Counts in the Rust model: steps it as the benches step the Verilog.

use tofsim::firmware::centroid_estimator::{self, CentroidEstimator};
use tofsim::firmware::depth_estimator::{self, DepthEstimator};
use tofsim::firmware::estimator_ctrl::{EstimatorCtrl, Params};
use tofsim::firmware::histogram_builder;
use tofsim::firmware::likelihood_estimator::LikelihoodEstimator;
use tofsim::firmware::spad_control::{self, SpadControl};
use tofsim::firmware::tof_top::slot::{SlotEstimator, SlotIn};
use tofsim::firmware::vcsel_driver::{self, VcselDriver};
use tofsim::kernel::{Clocked, U};

use super::design::CountedDesign;
use super::measured::Measured;

/// Cycles after which an estimation must be over.
const PATIENCE: u64 = 2000;

/// Everything that the benches print of such a design.
pub fn measure(design: &CountedDesign) -> Measured {
    let mut measured = Measured::default();
    estimator(&design.estimator, &mut measured);
    let size = histogram(&design.estimator);
    let centroid = centroid_estimator::Params { histogram: size, ..Default::default() };
    let most_hits = size.most_hits();
    latency::<CentroidEstimator>("centroid_latency", &centroid, most_hits, &mut measured);
    if let Some(params) = &design.likelihood {
        latency::<LikelihoodEstimator>("likelihood_latency", params, most_hits, &mut measured);
    }
    if let Some(scan) = &design.scan {
        scan.measure(&mut measured);
    }
    for mode in [false, true] {
        let codes = 0..design.laser.periods.len() as u64;
        codes.for_each(|code| shots(design, mode, code, &mut measured));
    }
    measured
}

/// The outputs of an estimator in each cycle of three estimations: one begins while it is idle, two
/// with a held start, which is taken again with `algo_done`. `edge` gives the outputs after an edge.
fn estimations<T>(
    patience: u64,
    mut edge: impl FnMut(bool) -> T,
    done: fn(&T) -> bool,
) -> [Vec<T>; 3] {
    [false, true, true].map(|hold| {
        let mut outputs = vec![edge(true)];
        while !outputs.last().is_some_and(done) && outputs.len() as u64 <= patience {
            outputs.push(edge(hold));
        }
        if !hold {
            edge(false);
        }
        outputs
    })
}

/// Counts the cycles of the layers and of the whole.
fn estimator(p: &Params, measured: &mut Measured) {
    let mut params = DepthEstimator::params_for(&histogram(p));
    params.forward2.neurons = p.neurons;
    let mut estimator = DepthEstimator::default();
    let edge = |algo_start| {
        estimator.rise(&depth_estimator::In { rst: false, algo_start, count: U::new(0) }, &params);
        estimator.estimator_ctrl
    };
    for outputs in estimations(PATIENCE, edge, |ctrl| ctrl.algo_done) {
        let cycles = |enable: fn(&EstimatorCtrl) -> bool| {
            outputs.iter().filter(|ctrl| enable(ctrl)).count() as u64
        };
        measured.add("forward1_cycles", cycles(|ctrl| ctrl.forward1_en));
        measured.add("tansig_cycles", cycles(|ctrl| ctrl.tansig_en));
        measured.add("forward2_cycles", cycles(|ctrl| ctrl.forward2_en));
        if outputs.last().is_some_and(|ctrl| ctrl.algo_done) {
            measured.add("latency", outputs.len() as u64 - 1);
        }
    }
}

/// Counts the cycles of an estimator: of an empty histogram, of a full one, and of one in between.
fn latency<E: SlotEstimator>(
    property: &str,
    p: &E::Params,
    most_hits: u64,
    measured: &mut Measured,
) {
    let mut estimator = E::default();
    let mut counts = [0, most_hits, 40].into_iter();
    let mut count = counts.next();
    let edge = |algo_start| {
        let count_now = U::new(count.unwrap_or(0));
        let i = SlotIn { algo_start, count: count_now, ..SlotIn::default() };
        estimator.rise(&i.into(), p);
        let algo_done = estimator.outputs().algo_done;
        if algo_done {
            count = counts.next();
        }
        algo_done
    };
    for outputs in estimations(2 * E::cycles(p), edge, |algo_done| *algo_done) {
        if outputs.last() == Some(&true) {
            measured.add(property, outputs.len() as u64 - 1);
        }
    }
}

fn histogram(p: &Params) -> histogram_builder::Params {
    histogram_builder::Params { bins: p.bins, ..Default::default() }
}

/// Counts five shots from the rise of `acquire` on.
fn shots(design: &CountedDesign, mode: bool, code: u64, measured: &mut Measured) {
    let laser_freq = U::new(code);
    let mut i = vcsel_driver::In {
        rst: false,
        rst_laser: false,
        acquire: false,
        laser_en: true,
        laser_freq,
        ..vcsel_driver::In::default()
    };
    let (mut driver, p, half_ps) = (VcselDriver::default(), &design.laser, design.half_ps);
    driver.rise(&i, p);
    driver.fall_laser();
    driver.rise_laser(&i, p);
    driver.fall_laser();
    let mut spad = SpadControl::default();
    i.acquire = true;
    let (mut shots, mut start_at, mut pre_start_at, mut spad_rst_at) = (0, 0, 0, 0);
    let (mut spad_rst_cycles, mut was_on, mut laser_on_at) = (0, false, 0);
    for k in 1..design.patience() {
        let pre_start = driver.registers.pre_start;
        spad = spad.next(&spad_control::In { mode, pre_start, ..Default::default() }, &());
        driver.rise(&i, p);
        if driver.registers.pre_start {
            pre_start_at = k;
        }
        if spad.spad_rst {
            (spad_rst_at, spad_rst_cycles) = (k, spad_rst_cycles + 1);
        }
        if driver.registers.start {
            let from = if shots == 0 { "first_shot" } else { "laser_period" };
            measured.add(format!("{from}_{code}"), k - start_at);
            measured.add("pre_start_lead", k - pre_start_at);
            if mode {
                measured.add("spad_rst_mode_1", spad_rst_cycles);
            } else {
                measured.add("spad_rst_lead", k - spad_rst_at);
                measured.add("spad_rst_width", spad_rst_cycles);
            }
            (shots, start_at, spad_rst_cycles) = (shots + 1, k, 0);
        }
        for half in 0..4 {
            match half {
                0 => {}
                2 => driver.rise_laser(&i, p),
                _ => driver.fall_laser(),
            }
            let now = (4 * k + half) * half_ps;
            match (was_on, driver.laser_on()) {
                (false, true) => laser_on_at = now,
                (true, false) => {
                    measured.add("laser_on_width", now - laser_on_at);
                    measured.add("laser_on_lag", laser_on_at.abs_diff(4 * start_at * half_ps));
                }
                _ => {}
            }
            was_on = driver.laser_on();
        }
        if shots == 5 {
            break;
        }
    }
}
