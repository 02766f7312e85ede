//! Control signals that change at random, and pulses planted where they matter.

use tofsim::firmware::tof_top::{FirmwareEstimator, Params};
use tofsim::scenario::{Control, QuenchMode};

use crate::golden::prelude::*;

/// Returns whether the estimator's status tells the mode of the shots.
pub(super) fn judges_mode(params: &Params) -> bool {
    params.estimator == FirmwareEstimator::LikelihoodEstimator
}

/// Cycles under random control, and then under pulses planted in the first shots of a frame.
pub(super) const RANDOM: usize = 20_000;
pub(super) const PLANTED: usize = 28_000;

/// Control signals that change at random times; some frames are abandoned twice, the second time in
/// Acquire.
pub(super) fn control(setting: &Setting, shots: u64) -> Vec<Control> {
    let mut draw = Draw::new(setting.seed, u64::MAX);
    let laser = &setting.setup.params.vcsel_driver;
    let codes = laser.periods.len() as u64;
    let last = (codes - 1, laser.periods[laser.periods.len() - 1]);
    let mut changes = Vec::new();
    let pll = setting.setup.pll();
    // Times are in eighths of a cycle.
    let at_us = |at| (pll.locked_at + stops::of_eighths(at, pll.cycle)).fs() as f64 * 1e-9;
    let (mut at, end) = (0, 8 * setting.cycles().min(RANDOM) as u64);
    let (mut again, times) = (false, FrameTimes::new(setting, shots));
    while at < end {
        let mut change = Control {
            at_us: at_us(at),
            laser_freq: draw.one_in(2).then(|| draw.below(codes)),
            mode: draw.one_in(8).then(|| draw.below(2)).and_then(|code| code.try_into().ok()),
            laser_en: draw.one_in(8).then(|| !draw.one_in(4)),
            dsp_en: draw.one_in(4).then(|| !draw.one_in(4)),
            dsp_rst: (again || draw.one_in(20)).then_some(true),
            rst: draw.one_in(60).then_some(true),
        };
        changes.push(change.clone());
        let pause = if draw.one_in(3) { 3000 } else { 200 };
        at += 1 + draw.below(pause);
        if change.dsp_rst.is_some() || change.rst.is_some() {
            change.at_us = at_us(at);
            (change.dsp_rst, change.rst) = (Some(false), Some(false));
            changes.push(change);
            again = draw.one_in(3);
            at += if again { times.acquire + draw.below(600) } else { 1 + draw.below(12_000) };
        } else {
            again = false;
        }
    }
    while at < 8 * setting.cycles() as u64 {
        for (span, change) in planted(shots, last, &times, &mut draw) {
            changes.push(Control { at_us: at_us(at), ..change });
            at += span;
        }
    }
    changes
}

/// When what comes in a frame of so many shots at the last rate [eighths of a cycle].
struct FrameTimes {
    /// A little more than Clear takes after a reset.
    acquire: u64,
    /// From the end of `dsp_rst` to the first shot.
    shots_begin: u64,
    /// From there to the start of the estimator.
    estimate: u64,
    /// The whole, and a little more.
    whole: u64,
    /// The whole with an estimator whose status tells the mode, if there is one.
    judged: Option<u64>,
}

impl FrameTimes {
    fn new(setting: &Setting, shots: u64) -> Self {
        let params = &setting.setup.params;
        let (bins, drain) = (params.histogram.bins as u64, params.frame_ctrl.drain_cycles);
        let periods = &params.vcsel_driver.periods;
        let estimate = 8 * (bins + shots * periods[periods.len() - 1] + drain);
        let whole = |done: u64| estimate + 8 * (done + 38);
        let judged = judges_mode(params).then(|| whole(params.estimators.likelihood_estimator.done()));
        let done = params.estimators.depth_estimator.ctrl().done();
        FrameTimes { acquire: 8 * (bins + 9), shots_begin: 8 * (bins - 1), estimate, whole: whole(done), judged }
    }
}

/// A frame begun anew at a rate of that code and period, and in it a short reset, another mode or a hold, in some cycle
/// of the shots or about the one that starts the estimator; each change and how long it lasts [eighths of a cycle].
fn planted(
    shots: u64,
    (rate, period): (u64, u64),
    times: &FrameTimes,
    draw: &mut Draw,
) -> [(u64, Control); 4] {
    let begin = Control {
        laser_freq: Some(rate),
        mode: Some(QuenchMode::EachShot),
        laser_en: Some(true),
        dsp_en: Some(true),
        dsp_rst: Some(true),
        ..Control::default()
    };
    let go = Control { dsp_rst: Some(false), ..Control::default() };
    let shots = times.shots_begin + draw.below(8 * period * shots);
    let kind = draw.below(if times.judged.is_some() { 11 } else { 9 });
    let (wait, span, change) = match kind {
        0..4 => (shots, 3 + draw.below(14), Control { rst: Some(true), ..Control::default() }),
        4..6 => (shots, 8, Control { dsp_rst: Some(true), ..Control::default() }),
        6 => (shots, 8 + draw.below(90), Control { mode: Some(QuenchMode::FreeRunning), ..Control::default() }),
        7..9 => (times.estimate + 8 * draw.below(3), 80, Control { dsp_en: Some(false), ..Control::default() }),
        _ => (times.estimate + 8 * draw.below(3), 80, Control { mode: Some(QuenchMode::FreeRunning), ..Control::default() }),
    };
    let end = Control {
        rst: Some(false),
        dsp_rst: Some(false),
        mode: Some(QuenchMode::EachShot),
        dsp_en: Some(true),
        ..Control::default()
    };
    // After another dsp_rst the frame is seen to its end, and so is an estimation whose mode changes as it begins.
    let rest = match (kind, times.judged) {
        (4..6, _) => times.whole,
        (9.., Some(judged)) => judged,
        _ => 400 + draw.below(300),
    };
    [(24, begin), (wait, go), (span, change), (rest, end)]
}
